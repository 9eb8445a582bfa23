#pragma once

#include <string>
#include <vector>

#include "trackbed/road_network/lane_route.h"

namespace trackbed {

/// Result of joining the lane centers of a route.
struct JoinedPath {
  /// Message that explains why the lane centers cannot be joined; empty on success.
  std::string failure;
  Path path;
  double deviation = 0.0;  ///< largest distance of the path from the lane centers [m]
};

/// Computes the path along the lane centers of consecutive stretches.
JoinedPath JoinLaneCenters(const RoadNetwork& network, const std::vector<LaneStretch>& stretches);

}  // namespace trackbed
