#pragma once

#include <vector>

#include "trackbed/planning/common/corners.h"

namespace trackbed {

/// Rounds the corners of a polyline like RoundCorners. RoundCorners fails if the path around a
/// sharp corner would pass the waypoint farther away than `max_gap`. RoundCorners also fails if
/// corners are too close together or the polyline turns back on itself. If RoundCorners fails and
/// `max_gap` is finite, the path skips waypoints that it passes within the distance `max_gap`
/// anyway. A rolling car may also continue straight until it is slow enough for the turn. If a
/// corner still cannot be rounded, the path leads straight through the waypoint at this corner.
/// Beyond the waypoint of such a corner, the path makes one or two quarter turns, and returns to
/// the next point of the polyline. A turn beyond a waypoint has the smallest radius of `limits` if
/// the car's speed permits, and may go to either side. If no turn to the polyline's next point
/// fits, the function returns the failure of RoundCorners. The reason of the failure names the
/// waypoint, its distance from the rounded path, and the remedies.
RoundedCorners RoundCornersOrTurnBehind(const VehicleParams& vehicle,
                                        const std::vector<Vec2>& polyline,
                                        const CornerLimits& limits, const CollisionChecker& clear);

}  // namespace trackbed
