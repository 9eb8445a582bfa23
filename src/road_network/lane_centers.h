#pragma once

#include <string>
#include <vector>

#include "trackbed/road_network/lane_route.h"

namespace trackbed {

/// Result of joining the lane centers of a route.
struct JoinedPath {
  std::string failure;  ///< reason of the failure, as a text for people; empty on success
  Path path;
  double deviation = 0.0;  ///< largest distance of the path from the centers [m]
};

/// Computes the path along the lane centers of consecutive stretches.
JoinedPath JoinLaneCenters(const RoadNetwork& network, const std::vector<LaneStretch>& stretches);

}  // namespace trackbed
