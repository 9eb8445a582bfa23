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
  double s = 0.0;  ///< [m]

  bool operator==(const LanePlace&) const = default;
};

/// A stretch of a route within one lane section.
struct LaneStretch {
  std::string road;
  int lane = 0;       ///< at its start
  int to_lane = 0;    ///< at its end: differs if the route changes lanes
  double from = 0.0;  ///< station of its start [m]
  double to = 0.0;    ///< station of its end [m]: below `from` if traffic runs against the road
};

/// A route over lanes and the path along their centers.
struct LaneRoute {
  std::string failure;  ///< why there is no route; empty if ok
  std::vector<LaneStretch> stretches;
  Path path;  ///< in the direction of traffic
  /// Largest distance of the path from the lanes' centers [m], at most 0.05.
  double deviation = 0.0;

  [[nodiscard]] bool ok() const { return failure.empty(); }
};

/// The pose of a car on the center of a lane, heading in the direction of its traffic.
/// PreconditionError as LanePositionAt.
Pose2 PoseAt(const RoadNetwork& network, const LanePlace& place);

/// Why a place is invalid, as the end of a sentence, "road 7 has no lane 3 at s = 12 m; it has 1,
/// -1, -2". Empty if it is valid: its road, station and lane exist, and the lane is drivable.
std::string LanePlaceError(const RoadNetwork& network, const LanePlace& place);

/// The shortest route over linked lanes from each place to the next, in the direction of traffic.
/// Lanes change only between two places in neighboring lanes of one lane section, over the whole
/// distance between them, by a quintic polynomial of the station.
///
/// The path follows the lanes' centers in the plane, with their curvature. Kinks of more than 1e-6
/// rad in the file's centers are rounded over 0.5 m on either side, and gaps are bridged;
/// `deviation` measures the effect of both. There is no route if a kink is above 0.2 rad, the
/// deviation above 0.05 m, the route longer than 100 km, or a lane lies beyond the center of
/// curvature of its road.
///
/// PreconditionError for fewer than two places, and for places that LanePlaceError rejects. Cost:
/// O(lanes of the network log lanes) for each pair of places, and about 30 us per meter.
LaneRoute FindLaneRoute(const RoadNetwork& network, const std::vector<LanePlace>& places);

}  // namespace trackbed
