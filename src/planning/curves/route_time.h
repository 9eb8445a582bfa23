#pragma once

#include "trackbed/planning/common/planner.h"

/// Driving times of routes, with the time in which the wheels turn before a start at rest.
namespace trackbed {

/// Returns the time in which the wheels turn to `curvature` [1/m] before a start at rest [s]; 0 for
/// a rolling car.
double TimeBeforeStart(const PlanRequest& request, double curvature);

/// Returns the driving time of a plan with TimeBeforeStart [s]; infinite without a path.
double TotalTime(const PlanRequest& request, const Plan& plan);

}  // namespace trackbed
