#pragma once

#include <array>
#include <set>
#include <string>
#include <utility>

#include "src/path_files/lanelet2_map.h"

namespace trackbed {

/// Returns the bounds of a lanelet in the lanelet's direction, by two rules.
///
/// The first rule compares the ends of the bounds: in a convex quadrilateral, two opposite sides
/// are together shorter than the diagonals. The first rule fails for U-turns whose ends are beside
/// each other.
///
/// The second rule is that of the library Lanelet2: the middle of each bound is on the correct side
/// of the other bound. The second rule fails for bounds that turn back on themselves.
std::array<LaneletBounds, 2> OrientationsOf(const LaneletBounds& bounds);

/// The nodes at which the lanelets of a map begin and end.
class LaneletEnds {
 public:
  /// Adds both ends of a lanelet.
  void Add(const LaneletBounds& bounds);

  /// Returns the orientation that begins or ends at the nodes of more other lanelets; of two that
  /// are equal in this, the first one.
  [[nodiscard]] LaneletBounds Choose(std::array<LaneletBounds, 2> orientations) const;

 private:
  using Nodes = std::pair<std::string, std::string>;  // of the left and the right bound
  [[nodiscard]] std::size_t Joints(const LaneletBounds& bounds) const;

  std::set<Nodes> begins_;
  std::set<Nodes> ends_;
};

}  // namespace trackbed
