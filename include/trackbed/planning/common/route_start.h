#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Returns the start of a route: the position of the first waypoint and the heading of the first
/// leg. The same waypoints give the same pose bit for bit, so that a path along the legs begins
/// exactly at the car's pose. The heading is 0 for a route of one waypoint. For an empty route, the
/// whole pose is 0.
Pose2 StartOfRoute(const std::vector<Vec2>& waypoints);

}  // namespace trackbed
