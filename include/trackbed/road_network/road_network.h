#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/road_network/reference_line.h"

/// Roads, lanes, and the links between roads and between lanes, with the terms of OpenDRIVE (ASAM
/// OpenDRIVE 1.7.0).
///
/// Symbols: s is the station along a road's reference line in the plane [m], from 0 to the road's
/// length; t is the lateral coordinate [m], positive to the left of the direction of growing s. The
/// center lane has no width and the number 0. Lanes to the left of the center lane are numbered 1,
/// 2, ..., lanes to the right -1, -2, ....
namespace trackbed {

/// The painted line at the outer border of a lane, or on the center lane.
struct RoadMark {
  /// Distance from the start of the lane section to the start of the road mark [m].
  double s = 0.0;
  /// Type of the road mark in the file: "solid", "broken", "solid solid", "none", ...
  std::string type;
  std::string color;   ///< Color of the road mark in the file: "standard", "white", "yellow", ...
  double width = 0.0;  ///< Width of the road mark [m]; 0 if the width is unknown.
};

/// The profile of a road's surface across the road at one station.
struct ShapeProfile {
  double s = 0.0;  ///< Station of the profile [m].
  /// Height above the surface that elevation and superelevation describe [m], upward, as a function
  /// of the lateral coordinate t [m].
  PiecewiseCubic height;
};

struct Lane {
  int id = 0;
  std::string type;  ///< Type of the lane in the file: "driving", "shoulder", "sidewalk", ...
  /// The width of the lane, or, if `has_border` is true, the t coordinate of the lane's outer
  /// border [m]. Width or border are functions of the distance from the start of the lane section
  /// [m].
  PiecewiseCubic extent;
  bool has_border = false;
  /// Numbers of the lanes to which a lane is linked at the start of its lane section (predecessors)
  /// and at the end of the section (successors). The start and end of the section refer to the
  /// direction of growing station s.
  std::vector<int> predecessors;
  std::vector<int> successors;
  std::vector<RoadMark> marks;
};

/// A part of a road with a constant number of lanes.
struct LaneSection {
  double s = 0.0;  ///< Station of the section's start [m].
  /// Lanes of the section from left to right; the lane numbers decrease by one from lane to lane.
  std::vector<Lane> lanes;

  /// Returns the lane with the number `lane`; null if the section has no such lane.
  [[nodiscard]] const Lane* Find(int lane) const;
};

enum class RoadEnd { kStart, kEnd };

/// The road or junction to which an end of a road is linked.
struct RoadLink {
  bool is_junction = false;
  std::string id;  ///< Id of the road or junction to which the road's end is linked.
  /// End of the linked road at which the two roads meet; unused if the link leads to a junction.
  RoadEnd contact = RoadEnd::kStart;
  int line = 0;  ///< Line number of the link in the OpenDRIVE file.
};

struct Road {
  std::string id;
  std::string name;
  double length = 0.0;  ///< Length of the road [m], > 0.
  /// Id of the junction that contains the road; nullopt if the road is not part of a junction.
  std::optional<std::string> junction;
  bool left_hand_traffic = false;
  ReferenceLine reference;
  PiecewiseCubic elevation;  ///< Height z of the reference line [m] as a function of the station s.
  /// Roll angle of the road's surface about the reference line [rad]; positive if the left side is
  /// higher.
  PiecewiseCubic superelevation;
  /// Profiles across the road, ordered by station. Between two profiles, the height is interpolated
  /// linearly over the station. The list of profiles is empty if all heights are 0.
  std::vector<ShapeProfile> shape;
  PiecewiseCubic lane_offset;  ///< Lateral coordinate t of the center lane [m] as a function of s.
  /// Lane sections, ordered by station; there is at least one section, and the first section starts
  /// at s = 0.
  std::vector<LaneSection> sections;
  std::optional<RoadLink> predecessor;
  std::optional<RoadLink> successor;
  /// Kinds of height data in the file that are not supported and therefore ignored: "crossfall",
  /// "crossSectionSurface", "lane height", "level lane".
  std::vector<std::string> unread_heights;
  int line = 0;  ///< Line number of the road in the OpenDRIVE file.

  /// Returns the index of the lane section at station s. At the border of two sections, returns the
  /// index of the section that begins at s.
  [[nodiscard]] std::size_t SectionAt(double s) const;
  /// Returns the station of a lane section's end [m].
  [[nodiscard]] double SectionEnd(std::size_t section) const;
};

/// A connection from an incoming road to a connecting road inside a junction.
struct JunctionConnection {
  std::string incoming;
  std::string connecting;
  /// End of the connecting road that touches the incoming road.
  RoadEnd contact = RoadEnd::kStart;
  /// Pairs of linked lanes: first a lane of the incoming road, then a lane of the connecting road.
  std::vector<std::pair<int, int>> lane_links;
  int line = 0;  ///< Line number of the connection in the OpenDRIVE file.
};

struct Junction {
  std::string id;
  std::vector<JunctionConnection> connections;
};

struct RoadNetwork {
  std::map<std::string, Road, std::less<>> roads;          ///< Roads by id.
  std::map<std::string, Junction, std::less<>> junctions;  ///< Junctions by id.
  /// Parts of the file that cannot be read and are left out, such as "road 7", "road 7 successor",
  /// "junction 2" and "junction 2 connection", each with a text for users. The text for users
  /// states the first problem of the broken part and the problem's line in the file.
  std::map<std::string, std::string, std::less<>> broken;
  /// Notes on parts of the file that are not used: broken roads, links to missing roads, junctions
  /// or lanes, invalid road marks, and heights that are not read.
  std::vector<std::string> notes;
};

/// The borders of a lane at one station: the lateral coordinates t [m], and their derivatives with
/// respect to the station s.
struct LaneBorders {
  CubicValue inner;  ///< Border of the lane toward the center lane.
  CubicValue outer;

  [[nodiscard]] CubicValue Center() const;
  /// Returns the width of the lane [m]; 0 for the center lane.
  [[nodiscard]] double Width() const;
};

/// Computes the borders of a lane at station s. Throws PreconditionError if the section does not
/// have the lane. Widths and offsets are evaluated with the polynomial pieces that apply at the
/// station `piece_of` [m]. Where two polynomial pieces meet, `piece_of` selects one of them. The
/// computing time is O(l log p) for l lanes and p polynomial pieces.
LaneBorders LaneBordersAt(const Road& road, std::size_t section, int lane, double s,
                          double piece_of);
LaneBorders LaneBordersAt(const Road& road, int lane, double s);

/// Returns the unit vector that points to the left across a road's surface: the horizontal normal
/// of the reference line, rotated by `roll` about the line's tangent in space. The argument
/// `tangent` is the derivative of the reference line with respect to the station, as seen from
/// above. The argument `slope` is the derivative of the reference line's elevation.
Eigen::Vector3d AcrossSurface(const Vec2& tangent, double slope, double roll);

/// A point on the surface of a road, with the heading of the road.
struct RoadPosition {
  double x = 0.0;  ///< Coordinate x [m].
  double y = 0.0;  ///< Coordinate y [m].
  double z = 0.0;  ///< Coordinate z [m].
  /// Heading of the reference line in the direction of growing s [rad], not wrapped.
  double heading = 0.0;
};

/// Returns the height that the profiles of a road add at station s and lateral coordinate t [m].
/// Beyond the first and last record of a profile, its outermost polynomials apply. Computing time:
/// O(log n) for n records.
double ShapeHeight(const Road& road, double s, double t);

/// The center of a lane, or another line along a road, at one station s: a point in the plane and
/// its derivatives with respect to s. The line along the road is at the distance t(s) from the
/// reference line, measured across the surface, which the superelevation rolls about the tangent of
/// the reference line. The height profiles of the road (Road::shape) do not move the line.
struct SurfaceLine {
  Vec2 position{0.0, 0.0};
  double heading = 0.0;    ///< Heading [rad].
  double curvature = 0.0;  ///< Curvature [1/m].
  double speed = 0.0;      ///< Derivative of the arc length in the plane with respect to s.
  /// Whether the distance t from the reference line is so large that the line runs backward, beyond
  /// the center of curvature.
  bool folded = false;
};

/// Returns the SurfaceLine at the distance `t` from the reference line. SurfaceLineAt uses the
/// polynomial pieces of the road that apply at the station `piece_of`.
SurfaceLine SurfaceLineAt(const Road& road, const CubicValue& t, double s, double piece_of);

/// Returns the point of the road's surface at station s and at the distance t [m] from the
/// reference line. The distance t is measured across the road's surface: along the left normal of
/// the reference line, rotated by the superelevation about the tangent of the reference line. The
/// height of the road's profiles (ShapeHeight) is added vertically. Height data of the kinds in
/// Road::unread_heights are ignored. Throws PreconditionError if the station is outside of the road
/// by more than 1 mm, or if a number is not finite.
RoadPosition PositionAt(const Road& road, double s, double t);

/// Returns the point of the road's surface at the distance `offset` [m] from the center of a lane,
/// positive to the left of the direction of growing s. Throws PreconditionError in the same cases
/// as PositionAt, and if the lane does not exist.
RoadPosition LanePositionAt(const Road& road, int lane, double s, double offset = 0.0);

/// Whether the road is flat and level: constant height, no superelevation, no profiles and no
/// ignored height data.
bool IsLevel(const Road& road);

/// Whether vehicles use the lane. Vehicles use lanes of these types: "driving", "entry", "exit",
/// "onRamp", "offRamp", "connectingRamp", "slipLane", "bidirectional", "bus", "taxi", "HOV",
/// "mwyEntry", "mwyExit".
bool IsDrivable(const Lane& lane);

/// Returns the numbers of the outermost drivable lanes of a section, the left lane first; 0 and 0,
/// the center lane, if no lane is drivable.
std::pair<int, int> OutermostLanes(const LaneSection& section);

/// Whether traffic on the lane moves in the direction of growing station s. Returns true for the
/// right lanes of a road with right-hand traffic, and for the left lanes of a road with left-hand
/// traffic.
bool FollowsRoad(const Road& road, int lane);

}  // namespace trackbed
