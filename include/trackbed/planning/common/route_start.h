#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// The start of a route: its first waypoint, with the heading of its first leg. The same waypoints
/// give the same pose bit for bit, so that a path along the legs begins exactly at the car's pose.
/// The heading is 0 for a route of one waypoint; the pose is 0 for an empty route.
Pose2 StartOfRoute(const std::vector<Vec2>& waypoints);

}  // namespace trackbed
