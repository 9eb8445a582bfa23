#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>

#include "src/path_files/lanelet2_map.h"

namespace trackbed {

/// Orients the bounds of the lanelets of a map. Two rules consider a lanelet alone.
///
/// The rule of ends compares the ends of the bounds: in a convex quadrilateral, two opposite sides
/// are together shorter than the diagonals. The rule of ends fails for U-turns whose ends are
/// beside each other.
///
/// The rule of sides is that of the library Lanelet2: the middle of each bound is on the correct
/// side of the other bound. The rule of sides fails for bounds that turn back on themselves.
///
/// Where both rules agree, the ends of a lanelet serve to check its neighbors.
class LaneletOrientation {
 public:
  /// Adds a lanelet of the map, whose bounds have any orientation.
  void Add(const LaneletBounds& bounds);

  /// Returns the bounds of a lanelet in the lanelet's direction, by the rule of ends. If this
  /// orientation joins no other lanelet, but another one joins lanelets at both ends, returns the
  /// other one: that of the rule of sides, or with one bound reversed.
  [[nodiscard]] LaneletBounds Orient(const LaneletBounds& bounds) const;

 private:
  using Nodes = std::pair<std::string, std::string>;  // of the left and the right bound
  [[nodiscard]] std::size_t Joints(const LaneletBounds& bounds) const;

  std::set<Nodes> begins_;  // Nodes at which lanelets begin.
  std::set<Nodes> ends_;    // Nodes at which lanelets end.
};

}  // namespace trackbed
