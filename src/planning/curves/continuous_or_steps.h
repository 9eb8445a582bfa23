#pragma once

#include <functional>

#include "trackbed/planning/common/planner.h"

/// Chooses between a path of continuous curvature and a path with steps of the curvature.
namespace trackbed {

/// Largest ratio of the driving time of a preferred path to that of another one. Above this ratio,
/// the other path is chosen.
inline constexpr double kMostTime = 1.2;

/// Returns the plan `continuous` unless the car cannot drive it, or drives the plan `steps` in much
/// less time. Plans with curvature steps are much faster on short legs where the car can only turn
/// its wheels at rest. A returned plan with curvature steps gets a note that says why its curvature
/// steps. If the car can drive neither of the plans, returns `steps`. The function `faster` makes
/// plans of continuous curvature faster; the caller applies `faster` to the returned plan. If
/// `faster` is not empty, the comparison uses the driving time of the plan that `faster` makes from
/// `continuous`.
Plan ContinuousOrSteps(Plan continuous, Plan steps, const PlanRequest& request,
                       const std::function<Plan(Plan)>& faster = {});

}  // namespace trackbed
