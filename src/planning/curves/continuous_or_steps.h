#pragma once

#include <functional>

#include "trackbed/planning/common/planner.h"

/// Chooses between a path of continuous curvature and one with steps.
namespace trackbed {

/// Returns the plan `continuous` unless the car cannot drive it, or drives the plan `steps` in much
/// less time. Plans with steps are much faster on short legs where the car can only turn its wheels
/// at rest. A plan with steps gets a note that says why. If the car can drive neither of the plans,
/// returns `steps`. If `faster` is not empty, the caller passes the result to this function, which
/// makes plans of continuous curvature faster; the plan `continuous` is judged by its time after
/// that.
Plan ContinuousOrSteps(Plan continuous, Plan steps, const PlanRequest& request,
                       const std::function<Plan(Plan)>& faster = {});

}  // namespace trackbed
