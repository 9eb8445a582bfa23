#pragma once

#include <string>
#include <vector>

#include "trackbed/road_network/lane_route.h"

namespace trackbed {

/// What the centers of a route's lanes are joined to.
struct JoinedPath {
  std::string failure;  ///< for people; empty when it was possible
  Path path;
  double deviation = 0.0;  ///< largest distance of the path from the centers [m]
};

/// The path along the centers of the stretches, one after the other.
JoinedPath JoinLaneCenters(const RoadNetwork& network, const std::vector<LaneStretch>& stretches);

}  // namespace trackbed
