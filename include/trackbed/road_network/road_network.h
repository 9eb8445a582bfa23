#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/road_network/reference_line.h"

/// Roads, their lanes and how they are linked, as OpenDRIVE describes them (ASAM OpenDRIVE 1.7.0).
///
/// Symbols: s station along a road's reference line in the plane [m], from 0 to its length;
/// t lateral coordinate [m], positive to the left of growing s. Lanes are counted from the center
/// lane, which has no width and the number 0: 1, 2, ... to the left, -1, -2, ... to the right.
namespace trackbed {

/// The painted line at the outer border of a lane, or on the center lane.
struct RoadMark {
  double s = 0.0;      ///< start, from the start of its lane section [m]
  std::string type;    ///< "solid", "broken", "solid solid", "none", ... as in the file
  std::string color;   ///< "standard", "white", "yellow", ... as in the file
  double width = 0.0;  ///< [m]; 0: unknown
};

struct Lane {
  int id = 0;
  std::string type;  ///< "driving", "shoulder", "sidewalk", ... as in the file
  /// Over the distance from the start of the lane section [m]: its width, or if `has_border` the
  /// t coordinate of its outer border.
  PiecewiseCubic extent;
  bool has_border = false;
  /// Linked lanes at the start and end of the section, in growing s.
  std::vector<int> predecessors;
  std::vector<int> successors;
  std::vector<RoadMark> marks;
};

/// A stretch of road with a constant number of lanes.
struct LaneSection {
  double s = 0.0;           ///< station of its start [m]
  std::vector<Lane> lanes;  ///< from left to right; numbers fall by one

  /// Null if there is no lane of that number.
  [[nodiscard]] const Lane* Find(int lane) const;
};

enum class RoadEnd { kStart, kEnd };

/// The road or junction beyond an end of a road.
struct RoadLink {
  bool is_junction = false;
  std::string id;                     ///< of that road or junction
  RoadEnd contact = RoadEnd::kStart;  ///< the end of that road; unused for junctions
  int line = 0;                       ///< in the file
};

struct Road {
  std::string id;
  std::string name;
  double length = 0.0;                  ///< [m], > 0
  std::optional<std::string> junction;  ///< the junction that it is part of
  bool left_hand_traffic = false;
  ReferenceLine reference;
  PiecewiseCubic elevation;       ///< z of the reference line [m] over s
  PiecewiseCubic superelevation;  ///< roll about the reference line [rad]: positive, left side up
  PiecewiseCubic lane_offset;     ///< t of the center lane [m] over s
  std::vector<LaneSection> sections;  ///< at least one, in growing s, the first at 0
  std::optional<RoadLink> predecessor;
  std::optional<RoadLink> successor;
  /// Additional heights in the file that are not supported: "shape", "crossfall", "lane height",
  /// "level lane".
  std::vector<std::string> unread_heights;
  int line = 0;  ///< in the file

  /// The index of the section at s; at a border, of the section that begins there.
  [[nodiscard]] std::size_t SectionAt(double s) const;
  /// Station of a section's end [m].
  [[nodiscard]] double SectionEnd(std::size_t section) const;
};

/// A connection from an incoming road to a road of the junction.
struct JunctionConnection {
  std::string incoming;
  std::string connecting;
  RoadEnd contact = RoadEnd::kStart;  ///< the end of the connecting road
  std::vector<std::pair<int, int>>
      lane_links;  ///< lane of the incoming, lane of the connecting road
  int line = 0;    ///< in the file
};

struct Junction {
  std::string id;
  std::vector<JunctionConnection> connections;
};

struct RoadNetwork {
  std::map<std::string, Road, std::less<>> roads;          ///< by id
  std::map<std::string, Junction, std::less<>> junctions;  ///< by id
  std::vector<std::string> notes;                          ///< unused parts of the file
};

/// The borders of a lane at one station, as t coordinates [m] with their derivatives over s.
struct LaneBorders {
  CubicValue inner;  ///< toward the center lane
  CubicValue outer;

  [[nodiscard]] CubicValue Center() const;
  /// Width [m]; 0 for the center lane.
  [[nodiscard]] double Width() const;
};

/// PreconditionError for a lane that the section does not have. At the border of two pieces of the
/// file's functions, `piece_of` [m] selects the applicable pieces. Cost O(lanes log
/// pieces).
LaneBorders LaneBordersAt(const Road& road, std::size_t section, int lane, double s,
                          double piece_of);
LaneBorders LaneBordersAt(const Road& road, int lane, double s);

/// The unit vector across a road's surface to the left of its reference line: the level normal of
/// the line, rotated by `roll` about its tangent in space. `tangent` is the derivative of the line
/// over the station, as seen from above, `slope` that of its elevation.
Eigen::Vector3d AcrossSurface(const Vec2& tangent, double slope, double roll);

/// A point on the surface of a road.
struct RoadPosition {
  double x = 0.0;        ///< [m]
  double y = 0.0;        ///< [m]
  double z = 0.0;        ///< [m]
  double heading = 0.0;  ///< of the reference line, towards growing s [rad]; not wrapped
};

/// The point at the distance t [m] from the reference line along the surface: along the left normal
/// of the line, rotated by the superelevation about the line's tangent in space. Excludes the
/// heights of Road::unread_heights. PreconditionError for a station outside of the road by more
/// than 1 mm, or numbers that are not finite.
RoadPosition PositionAt(const Road& road, double s, double t);

/// As PositionAt, at the distance `offset` [m] from the center of a lane, positive to the left of
/// growing s. PreconditionError also for a missing lane.
RoadPosition LanePositionAt(const Road& road, int lane, double s, double offset = 0.0);

/// Whether the road is level at constant height: no slope, no superelevation, no unread heights.
bool IsLevel(const Road& road);

/// Whether vehicles use lanes of this type: "driving", "entry", "exit", "onRamp", "offRamp",
/// "connectingRamp", "slipLane", "bidirectional", "bus", "taxi", "HOV", "mwyEntry", "mwyExit".
bool IsDrivable(const Lane& lane);

/// Whether traffic on the lane moves towards growing s: right lanes in right-hand traffic, left
/// lanes in left-hand traffic.
bool FollowsRoad(const Road& road, int lane);

}  // namespace trackbed
