#pragma once

#include <string>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// A place on the center of a lane.
struct LanePlace {
  std::string road;
  int lane = 0;
  double s = 0.0;  ///< Station [m].

  bool operator==(const LanePlace&) const = default;
};

/// A stretch of a route within one lane section.
struct LaneStretch {
  std::string road;
  int lane = 0;  ///< Lane at the start of the stretch.
  /// Lane at the end of the stretch, which differs if the route changes lanes.
  int to_lane = 0;
  double from = 0.0;  ///< Station of the start [m].
  /// Station of the end [m], below `from` if traffic runs against the road.
  double to = 0.0;
};

/// A route over lanes and the path along their centers.
struct LaneRoute {
  std::string failure;  ///< Reason why there is no route; empty if ok.
  std::vector<LaneStretch> stretches;
  Path path;  ///< Path in the direction of traffic.
  /// Largest distance of the path from the lanes' centers [m], at most 0.05.
  double deviation = 0.0;

  [[nodiscard]] bool ok() const { return failure.empty(); }
};

/// The pose of a car on the center of a lane, heading in the direction of its traffic. Throws the
/// PreconditionErrors of LanePositionAt.
Pose2 PoseAt(const RoadNetwork& network, const LanePlace& place);

/// Checks a place. Returns an empty text if the road, the station and the lane of the place exist,
/// and the lane is drivable. Otherwise returns the end of an error message, such as "road 7 has no
/// lane 3 at s = 12 m; it has 1, -1, -2".
std::string LanePlaceError(const RoadNetwork& network, const LanePlace& place);

/// Finds the shortest route over linked lanes from each place to the next, in the direction of
/// traffic. The route only changes lanes between two places in neighboring lanes of one lane
/// section. The lane change is a quintic polynomial of the station, over the whole distance between
/// the places.
///
/// The path follows the lanes' centers in the plane, with their curvature. Kinks of more than 1e-6
/// rad in the lane centers of the file are rounded over 0.5 m on either side, and gaps are bridged;
/// `deviation` measures the effect of both. There is no route if a kink exceeds 0.2 rad, the
/// deviation exceeds 0.05 m, or the route is longer than 100 km. There is also no route if a lane
/// lies beyond the center of curvature of its road.
///
/// PreconditionError for fewer than two places, and for places that LanePlaceError rejects. Cost:
/// O(n log n) for each pair of places in a network of n lanes, and about 30 us per meter.
LaneRoute FindLaneRoute(const RoadNetwork& network, const std::vector<LanePlace>& places);

}  // namespace trackbed
