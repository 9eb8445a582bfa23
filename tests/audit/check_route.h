#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/audit/checker.h"

/// Checks the plan of an ordinary route (ordinary_routes.h), or the reason why there is none. The
/// checks measure the mission and the rows of the plan by themselves.
namespace audit {

/// Properties of a planner that the checks need.
struct RoutePlanner {
  std::string name;
  bool meets_waypoints = false;  ///< Passes through every waypoint, not only near it.
  bool bounds_misses = false;    ///< Passes every waypoint within a car's length.
};

/// Checks a plan against the route: its limits (CheckPlan), its distance from every waypoint, and
/// whether it stops where the wheels need not turn.
std::vector<Finding> CheckRoutePlan(const Record& record, const RoutePlanner& planner);

/// Checks whether the reason of a refused plan is true. `is_planned_at` tells whether the planner
/// finds a plan for a car that starts at a speed [m/s].
std::vector<Finding> CheckRefusal(const Record& record, const RoutePlanner& planner,
                                  const std::function<bool(double start_speed)>& is_planned_at);

}  // namespace audit
