#pragma once

#include <vector>

#include "trackbed/planning/common/corners.h"

namespace trackbed {

/// Rounds the corners of a polyline like RoundCorners. A corner at a waypoint may be too sharp for
/// `max_gap`, too close to its neighbors, or turn back on itself. If `max_gap` is finite, the path
/// then leaves out waypoints that it passes within `max_gap` anyway. A rolling car may also
/// continue straight until it is slow enough. If this does not suffice, the path leads straight
/// through the waypoint, turns by one or two quarters behind it, and returns to the next point of
/// the polyline. A turn behind a waypoint uses the smallest radius of the limits where the speed
/// allows this, and may turn to either side. If no turn to the next point fits, returns the failure
/// of RoundCorners; the reason names the waypoint, its distance from the curve, and the remedies.
RoundedCorners RoundCornersOrTurnBehind(const VehicleParams& vehicle,
                                        const std::vector<Vec2>& polyline,
                                        const CornerLimits& limits, const CollisionChecker& clear);

}  // namespace trackbed
