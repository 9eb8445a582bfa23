#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Returns the start pose of a route: the position of the first waypoint and the heading of the
/// first leg. The same waypoints always yield a bit-identical pose, so that a path along the legs
/// begins exactly at the car's pose. For a route of one waypoint, the heading is 0; for an empty
/// route, position and heading are 0.
Pose2 StartOfRoute(const std::vector<Vec2>& waypoints);

}  // namespace trackbed
