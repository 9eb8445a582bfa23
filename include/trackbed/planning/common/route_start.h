#pragma once

#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// The start of a route: its first waypoint, with the heading of its first leg. The same waypoints
/// give the same pose bit for bit, so that a path along the legs begins exactly at the car's pose.
/// A route of one waypoint has the heading 0; an empty route has the pose 0.
Pose2 StartOfRoute(const std::vector<Vec2>& waypoints);

}  // namespace trackbed
