#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Where a route begins: at its first waypoint, along its first leg. The same waypoints give the
/// same pose bit for bit, so that a path along the legs begins as the car stands. The heading is 0
/// for a route of one waypoint, the whole pose for one of none.
Pose2 StartOfRoute(const std::vector<Vec2>& waypoints);

}  // namespace trackbed
