#pragma once

#include <string>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// A place on the center of a lane: road, lane and station.
struct LanePlace {
  std::string road;
  int lane = 0;
  double s = 0.0;  ///< Station [m].

  bool operator==(const LanePlace&) const = default;
};

/// A part of a route within one lane section.
struct LaneStretch {
  std::string road;
  int lane = 0;  ///< Number of the lane at the start of the stretch.
  /// Number of the lane at the end of the stretch; differs from the lane at the start if the route
  /// changes lanes.
  int to_lane = 0;
  double from = 0.0;  ///< Station of the stretch's start [m].
  /// Station of the stretch's end [m]; smaller than `from` if the traffic moves against the
  /// direction of growing stations.
  double to = 0.0;
};

/// A route over lanes, and the path along the centers of the lanes.
struct LaneRoute {
  std::string failure;  ///< Reason why there is no route; empty if a route was found.
  std::vector<LaneStretch> stretches;
  Path path;  ///< Path along the route, in the direction of traffic.
  /// Largest distance of the path from the lanes' centers [m], at most 0.05.
  double deviation = 0.0;
  /// Number, largest size and place of the gaps between lanes that the path closes, for users;
  /// empty if no gap exceeds 1 mm.
  std::string note;

  [[nodiscard]] bool ok() const { return failure.empty(); }
};

/// Returns the pose of a car on the center of a lane, heading in the direction of the lane's
/// traffic. Throws PreconditionError in the same cases as LanePositionAt.
Pose2 PoseAt(const RoadNetwork& network, const LanePlace& place);

/// Returns why `place` cannot be part of a route, such as "road 7 has no lane 3 at s = 12 m; it has
/// 1, -1, -2". Returns an empty text if the road, the station and the lane of the place exist and
/// the lane is drivable.
std::string LanePlaceError(const RoadNetwork& network, const LanePlace& place);

/// Finds the shortest route over linked lanes from each place to the next, in the direction of
/// traffic. The route changes lanes only between two given places that are in neighboring lanes of
/// the same lane section. The lateral offset during a lane change is a quintic polynomial of the
/// station, over the whole distance between the two places.
///
/// The path follows the centers of the lanes in the plane, with the curvature of the lane centers.
/// Kinks of more than 1e-6 rad in the centers of lanes are rounded over 0.5 m on either side.
/// Across a gap between lanes, the path moves sideways over a length that adds at most 1e-3 1/m of
/// curvature: 7.6 m for a gap of 1 cm. Away from kinks and gaps, the path is within 1 mm of the
/// centers of the lanes. The value `deviation` is the largest distance by which the rounding of
/// kinks and the closing of gaps move the path. FindLaneRoute finds no route if a kink exceeds 0.2
/// rad, if the deviation exceeds 0.05 m, or if the route is longer than 100 km. FindLaneRoute also
/// finds no route if a lane lies beyond the center of curvature of the lane's road. If a route is
/// missing because the file has broken links or roads (RoadNetwork::broken), `failure` names the
/// broken parts.
///
/// Throws PreconditionError if there are fewer than two places, or if LanePlaceError rejects a
/// place. The cost is O(n log n) for each pair of places in a network of n lanes, plus about 30 us
/// per meter of path.
LaneRoute FindLaneRoute(const RoadNetwork& network, const std::vector<LanePlace>& places);

}  // namespace trackbed
