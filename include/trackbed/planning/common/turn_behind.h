#pragma once

#include <vector>

#include "trackbed/planning/common/corners.h"

namespace trackbed {

/// Rounds the corners of a polyline like RoundCorners. RoundCorners fails if a corner at a waypoint
/// is too sharp for `max_gap`, is too close to its neighbors, or turns back on itself. If
/// RoundCorners fails and `max_gap` is finite, the path leaves out waypoints that it passes within
/// `max_gap` anyway. A rolling car may also continue straight until it is slow enough for the turn.
/// If the corner still cannot be rounded, the path leads straight through the waypoint. Behind the
/// waypoint, the path makes one or two quarter turns, and returns to the next point of the
/// polyline. A turn behind a waypoint has the smallest radius of `limits` if the speed permits, and
/// may go to either side. If no turn to the polyline's next point fits, the function returns the
/// failure of RoundCorners. The failure's reason names the waypoint, its distance from the curve,
/// and the remedies.
RoundedCorners RoundCornersOrTurnBehind(const VehicleParams& vehicle,
                                        const std::vector<Vec2>& polyline,
                                        const CornerLimits& limits, const CollisionChecker& clear);

}  // namespace trackbed
