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
  double s = 0.0;      ///< where it begins, from the start of its lane section [m]
  std::string type;    ///< "solid", "broken", "solid solid", "none", ... as in the file
  std::string color;   ///< "standard", "white", "yellow", ... as in the file
  double width = 0.0;  ///< [m]; 0: not given
};

struct Lane {
  int id = 0;
  std::string type;  ///< "driving", "shoulder", "sidewalk", ... as in the file
  /// Over the distance from the start of the lane section [m]: its width, or if `has_border` the
  /// t coordinate of its outer border.
  PiecewiseCubic extent;
  bool has_border = false;
  /// Lanes that it is linked with at the start and end of its section, in growing s.
  std::vector<int> predecessors;
  std::vector<int> successors;
  std::vector<RoadMark> marks;
};

/// Lanes that do not change in number.
struct LaneSection {
  double s = 0.0;           ///< where it begins [m]
  std::vector<Lane> lanes;  ///< from left to right, their numbers falling by one from each to next

  /// Null when there is none of that number.
  [[nodiscard]] const Lane* Find(int lane) const;
};

enum class RoadEnd { kStart, kEnd };

/// What lies beyond an end of a road.
struct RoadLink {
  bool is_junction = false;
  std::string id;                     ///< of the road or the junction
  RoadEnd contact = RoadEnd::kStart;  ///< the end of that road; unused for junctions
  int line = 0;                       ///< in the file
};

struct Road {
  std::string id;
  std::string name;
  double length = 0.0;                  ///< [m], > 0
  std::optional<std::string> junction;  ///< that it is part of
  bool left_hand_traffic = false;
  ReferenceLine reference;
  PiecewiseCubic elevation;       ///< z of the reference line [m] over s
  PiecewiseCubic superelevation;  ///< roll about the reference line [rad]: positive, left side up
  PiecewiseCubic lane_offset;     ///< t of the center lane [m] over s
  std::vector<LaneSection> sections;  ///< at least one, in growing s, the first at 0
  std::optional<RoadLink> predecessor;
  std::optional<RoadLink> successor;
  /// Heights that the file has besides and that are not read: "shape", "crossfall", "lane height",
  /// "level lane".
  std::vector<std::string> unread_heights;
  int line = 0;  ///< in the file

  /// The index of the section at s; at a border, of the one that begins there.
  [[nodiscard]] std::size_t SectionAt(double s) const;
  /// Where a section ends [m].
  [[nodiscard]] double SectionEnd(std::size_t section) const;
};

/// Leads from an incoming road onto a road of the junction.
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
  std::vector<std::string> notes;  ///< what of the file was not used, for people
};

/// The borders of a lane at one station, as t coordinates [m] with their derivatives over s.
struct LaneBorders {
  CubicValue inner;  ///< toward the center lane
  CubicValue outer;

  [[nodiscard]] CubicValue Center() const;
  /// [m]; 0 for the center lane.
  [[nodiscard]] double Width() const;
};

/// PreconditionError for a lane that the section does not have. `piece_of` [m] chooses, where
/// pieces of the file's functions meet, whose values count: those in force at that station. Cost
/// O(lanes log pieces).
LaneBorders LaneBordersAt(const Road& road, std::size_t section, int lane, double s,
                          double piece_of);
LaneBorders LaneBordersAt(const Road& road, int lane, double s);

/// The unit vector across a road's surface to the left of its reference line: the level normal of
/// the line, turned by `roll` about its tangent in space. `tangent` is the derivative of the line
/// by the station, as seen from above, `slope` that of its elevation.
Eigen::Vector3d AcrossSurface(const Vec2& tangent, double slope, double roll);

/// A point on the surface of a road.
struct RoadPosition {
  double x = 0.0;        ///< [m]
  double y = 0.0;        ///< [m]
  double z = 0.0;        ///< [m]
  double heading = 0.0;  ///< of the reference line, towards growing s [rad]; not wrapped
};

/// The point beside the reference line by t [m] along the surface: the left normal of the line,
/// turned by the superelevation about the line's tangent in space. Heights of Road::unread_heights
/// are not in it. PreconditionError for a station outside of the road by more than 1 mm, or numbers
/// that are not finite.
RoadPosition PositionAt(const Road& road, double s, double t);

/// The same beside the center of a lane by `offset` [m], positive to the left of growing s.
/// PreconditionError also for a lane that is not there.
RoadPosition LanePositionAt(const Road& road, int lane, double s, double offset = 0.0);

/// Whether the road lies level at one height: no slope, no superelevation, no unread heights.
bool IsLevel(const Road& road);

/// Whether vehicles drive on lanes of the type: "driving", "entry", "exit", "onRamp", "offRamp",
/// "connectingRamp", "slipLane", "bidirectional", "bus", "taxi", "HOV", "mwyEntry", "mwyExit".
bool IsDrivable(const Lane& lane);

/// Whether traffic on the lane goes towards growing s: right lanes in right-hand traffic, left
/// lanes in left-hand traffic.
bool FollowsRoad(const Road& road, int lane);

}  // namespace trackbed
