#pragma once

#include <functional>

#include "trackbed/planning/common/planner.h"

/// Chooses between a path of continuous curvature and a path with steps of the curvature.
namespace trackbed {

/// Returns the driving time of a plan with the time in which the wheels turn before the start [s];
/// infinite if the car cannot drive the plan from its start speed.
double DrivableTime(const PlanRequest& request, const Plan& plan);

/// Returns the plan `continuous` unless the car cannot drive it. Otherwise, returns the plan that
/// the function `steps` makes, with a note that says why its curvature steps.
Plan DrivableOrSteps(Plan continuous, const PlanRequest& request,
                     const std::function<Plan()>& steps);

/// Returns the plan `continuous` if the car can drive it in at most `most` times the driving time
/// of the plan `steps`, and `steps` otherwise. A returned plan with curvature steps gets a note
/// that says why its curvature steps. If the car can drive neither of the plans, returns `steps`.
Plan ContinuousOrSteps(Plan continuous, Plan steps, const PlanRequest& request, double most = 1.0);

/// Returns the fastest of three plans: `best`, a path with steps of the curvature, and a path of
/// continuous curvature through the stops of the path with steps. The path with steps may have
/// other headings than `best`, or leave out waypoints. If the third plan leaves out waypoints, a
/// note names how far the path passes from them; the path passes every waypoint within
/// kUnnoticedShareOfWidth. The function `plan_steps` plans the path with steps, and the function
/// `plan_through` a path of continuous curvature through the stops of a request.
Plan FastestCurves(Plan best, const PlanRequest& request, const std::function<Plan()>& plan_steps,
                   const std::function<Plan(const PlanRequest&)>& plan_through);

}  // namespace trackbed
