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
  int to_lane = 0;    ///< at its end: another one where the route changes lanes
  double from = 0.0;  ///< station where it begins [m]
  double to = 0.0;    ///< and ends [m]: below `from` where traffic goes against the road
};

/// A way over lanes and the path along their centers.
struct LaneRoute {
  std::string failure;  ///< why there is none, for people; empty when there is one
  std::vector<LaneStretch> stretches;
  Path path;               ///< in the direction of traffic
  double deviation = 0.0;  ///< largest distance of the path from the centers [m], at most 0.05

  [[nodiscard]] bool ok() const { return failure.empty(); }
};

/// The pose of a car on the center of a lane, heading along its traffic. PreconditionError as
/// LanePositionAt.
Pose2 PoseAt(const RoadNetwork& network, const LanePlace& place);

/// What is wrong with a place as the end of a sentence, "road 7 has no lane 3 at s = 12 m; it has
/// 1, -1, -2", or empty: its road, station and lane must be there, and the lane drivable.
std::string WhyNoPlace(const RoadNetwork& network, const LanePlace& place);

/// The shortest way over linked lanes from each place to the next, in the direction of traffic.
/// Lanes are changed only between two places in neighboring lanes of one lane section, over the
/// whole distance between them, by a quintic polynomial of the station.
///
/// The path follows the lanes' centers in the plane, with their own curvature. Where the file's
/// centers have a kink of more than 1e-6 rad, they are rounded over 0.5 m on either side; where
/// they have a gap, it is passed over. `deviation` is what comes of both. There is no route where a
/// kink is above 0.2 rad, the deviation above 0.05 m, the way longer than 100 km, or a lane lies
/// beyond the center of curvature of its road.
///
/// PreconditionError for fewer than two places and for those that WhyNoPlace refuses. Cost: O(lanes
/// of the network log lanes) for each pair of places, and about 30 us a meter.
LaneRoute FindLaneRoute(const RoadNetwork& network, const std::vector<LanePlace>& places);

}  // namespace trackbed
