#pragma once

#include <vector>

#include "src/planning/fillet/fillet_layout.h"

namespace trackbed::fillet {

/// Leaves out waypoints if a turn has no room on its legs, and if the turns at the remaining
/// waypoints have room. The remaining legs must pass each waypoint within a quarter of the car's
/// width and FilletOptions::max_waypoint_miss. If some turn would still lack room, or a leg would
/// pass a waypoint too far away, returns the route unchanged. Start, goal and the direction of the
/// first leg stay the same.
Route WithoutCloseWaypoints(const VehicleParams& vehicle, const Route& route, double speed,
                            const FilletOptions& options);

/// Whether a route by WithoutCloseWaypoints leaves out the waypoint `i` of the mission.
bool IsLeftOut(const Route& route, const std::vector<Vec2>& waypoints, int i);

}  // namespace trackbed::fillet
