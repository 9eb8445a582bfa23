#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/road_network/reference_line.h"

/// Roads, their lanes and their links, in the terms of OpenDRIVE (ASAM OpenDRIVE 1.7.0).
///
/// Symbols: s station along a road's reference line in the plane [m], from 0 to its length; t
/// lateral coordinate [m], positive to the left in the direction of growing s. The center lane has
/// no width and the number 0. Lanes to the left of the center lane are numbered 1, 2, ..., lanes to
/// the right -1, -2, ....
namespace trackbed {

/// The painted line at the outer border of a lane, or on the center lane.
struct RoadMark {
  double s = 0.0;      ///< Distance of the start from the start of the lane section [m].
  std::string type;    ///< Type in the file: "solid", "broken", "solid solid", "none", ...
  std::string color;   ///< Color in the file: "standard", "white", "yellow", ...
  double width = 0.0;  ///< Width [m]; 0: unknown.
};

struct Lane {
  int id = 0;
  std::string type;  ///< Type in the file: "driving", "shoulder", "sidewalk", ...
  /// The width of the lane, or with `has_border` the t coordinate of its outer border. The extent
  /// is a function of the distance from the start of the lane section [m].
  PiecewiseCubic extent;
  bool has_border = false;
  /// Numbers of the lanes linked at the start (predecessors) and end (successors) of the section,
  /// in the direction of growing s.
  std::vector<int> predecessors;
  std::vector<int> successors;
  std::vector<RoadMark> marks;
};

/// A stretch of road with a constant number of lanes.
struct LaneSection {
  double s = 0.0;           ///< Station of the start [m].
  std::vector<Lane> lanes;  ///< Lanes from left to right, with numbers that decrease by one.

  /// Returns the lane with the number `lane`; null if the section has no such lane.
  [[nodiscard]] const Lane* Find(int lane) const;
};

enum class RoadEnd { kStart, kEnd };

/// The road or junction to which an end of a road is linked.
struct RoadLink {
  bool is_junction = false;
  std::string id;  ///< Id of the linked road or junction.
  /// End of the linked road at which the two roads meet; unused for junctions.
  RoadEnd contact = RoadEnd::kStart;
  int line = 0;  ///< Line in the file.
};

struct Road {
  std::string id;
  std::string name;
  double length = 0.0;                  ///< Length [m], > 0.
  std::optional<std::string> junction;  ///< Id of the junction that contains the road.
  bool left_hand_traffic = false;
  ReferenceLine reference;
  PiecewiseCubic elevation;  ///< Height z of the reference line [m] as a function of s.
  /// Roll about the reference line [rad]; positive if the left side is higher.
  PiecewiseCubic superelevation;
  PiecewiseCubic lane_offset;  ///< Coordinate t of the center lane [m] as a function of s.
  /// Sections in the order of s, at least one; the first starts at 0.
  std::vector<LaneSection> sections;
  std::optional<RoadLink> predecessor;
  std::optional<RoadLink> successor;
  /// Kinds of additional heights in the file that are not supported: "shape", "crossfall", "lane
  /// height", "level lane".
  std::vector<std::string> unread_heights;
  int line = 0;  ///< Line in the file.

  /// Returns the index of the section at s. At the border of two sections, the index is that of the
  /// section that begins at s.
  [[nodiscard]] std::size_t SectionAt(double s) const;
  /// Returns the station of a section's end [m].
  [[nodiscard]] double SectionEnd(std::size_t section) const;
};

/// A connection from an incoming road to a connecting road of the junction.
struct JunctionConnection {
  std::string incoming;
  std::string connecting;
  RoadEnd contact = RoadEnd::kStart;  ///< End of the connecting road at the incoming road.
  /// Pairs of linked lanes: a lane of the incoming road and a lane of the connecting road.
  std::vector<std::pair<int, int>> lane_links;
  int line = 0;  ///< Line in the file.
};

struct Junction {
  std::string id;
  std::vector<JunctionConnection> connections;
};

struct RoadNetwork {
  std::map<std::string, Road, std::less<>> roads;          ///< Roads by id.
  std::map<std::string, Junction, std::less<>> junctions;  ///< Junctions by id.
  std::vector<std::string> notes;                          ///< Notes on unused parts of the file.
};

/// The borders of a lane at one station, as t coordinates [m] with their derivatives over s.
struct LaneBorders {
  CubicValue inner;  ///< Border toward the center lane.
  CubicValue outer;

  [[nodiscard]] CubicValue Center() const;
  /// The width of the lane [m]; 0 for the center lane.
  [[nodiscard]] double Width() const;
};

/// Computes the borders of a lane. PreconditionError for a lane that the section does not have. The
/// polynomial pieces of the file's functions are those that apply at the station `piece_of` [m],
/// which matters where two pieces meet. Cost O(lanes log pieces).
LaneBorders LaneBordersAt(const Road& road, std::size_t section, int lane, double s,
                          double piece_of);
LaneBorders LaneBordersAt(const Road& road, int lane, double s);

/// Returns the unit vector that points to the left across a road's surface: the horizontal normal
/// of the reference line, rotated by `roll` about the line's tangent in space. `tangent` is the
/// derivative of the line over the station, as seen from above; `slope` is the derivative of the
/// line's elevation.
Eigen::Vector3d AcrossSurface(const Vec2& tangent, double slope, double roll);

/// A point on the surface of a road.
struct RoadPosition {
  double x = 0.0;  ///< Coordinate x [m].
  double y = 0.0;  ///< Coordinate y [m].
  double z = 0.0;  ///< Coordinate z [m].
  /// Heading of the reference line in the direction of growing s [rad], not wrapped.
  double heading = 0.0;
};

/// Returns the point of the road's surface at the distance t [m] from the reference line. The
/// distance is measured along the left normal of the line, rotated by the superelevation about the
/// line's tangent in space. The heights of Road::unread_heights are ignored. PreconditionError for
/// a station outside of the road by more than 1 mm, or numbers that are not finite.
RoadPosition PositionAt(const Road& road, double s, double t);

/// As PositionAt, at the distance `offset` [m] from the center of a lane, positive to the left in
/// the direction of growing s. PreconditionError for a missing lane.
RoadPosition LanePositionAt(const Road& road, int lane, double s, double offset = 0.0);

/// Whether the road is level at constant height, without slope, superelevation and unread heights.
bool IsLevel(const Road& road);

/// Whether vehicles use lanes of this type: "driving", "entry", "exit", "onRamp", "offRamp",
/// "connectingRamp", "slipLane", "bidirectional", "bus", "taxi", "HOV", "mwyEntry", "mwyExit".
bool IsDrivable(const Lane& lane);

/// Whether traffic on the lane moves in the direction of growing s. True for the right lanes in
/// right-hand traffic, and the left lanes in left-hand traffic.
bool FollowsRoad(const Road& road, int lane);

}  // namespace trackbed
