#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/audit/checker.h"

/// Checks the plan of an ordinary route (ordinary_routes.h), or the reason why there is none. The
/// checks compute all quantities from the mission and the rows of the plan, without the program's
/// code.
namespace audit {

/// Properties of a planner that the checks need.
struct RoutePlanner {
  std::string name;
  /// Whether paths of the planner pass exactly through every waypoint.
  bool meets_waypoints = false;
  /// Whether paths of the planner pass within a car's length of every waypoint.
  bool bounds_misses = false;
};

/// Checks a plan against the route: its limits (CheckPlan), its distance from every waypoint, and
/// whether it stops where the wheels need not turn.
std::vector<Finding> CheckRoutePlan(const Record& record, const RoutePlanner& planner);

/// Checks whether the reason of a refused plan is true. `is_planned_at` tells whether the planner
/// finds a plan for a car that starts at a speed [m/s].
std::vector<Finding> CheckRefusal(const Record& record, const RoutePlanner& planner,
                                  const std::function<bool(double start_speed)>& is_planned_at);

}  // namespace audit
