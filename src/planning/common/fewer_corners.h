#pragma once

#include <vector>

#include "trackbed/planning/common/corners.h"

namespace trackbed {

/// Leaves out waypoints that are too close to each other for the curves of their corners. The first
/// and last point and the direction of the first leg stay the same. A point may be left out if it
/// is a waypoint within `max_gap` of the leg that replaces it or of the first leg, or if it lies on
/// the leg that replaces it. Of all
/// such polylines, returns the one with the fewest corners that the car cannot drive at
/// `min_speed`; then the one with the most points; then the one that is nearest to the points left
/// out. Cost: O(n w^2) for n points, of which at most w = 50 are left out in a row.
std::vector<Vec2> LeaveOutCloseWaypoints(const VehicleParams& vehicle,
                                         const std::vector<Vec2>& polyline,
                                         const CornerLimits& limits);

}  // namespace trackbed
