#include "src/planning/curves/continuous_or_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "src/planning/curves/route_time.h"
#include "trackbed/planning/common/feasibility.h"

namespace trackbed {

Plan ContinuousOrSteps(Plan continuous, Plan steps, const PlanRequest& request,
                       const std::function<Plan(Plan)>& faster) {
  // Do not accept a plan that exceeds a limit, even if the request permits infeasible plans.
  PlanRequest strict = request;
  strict.infeasible = InfeasiblePolicy::kSlowDown;
  const FeasiblePlan smooth = MakeFeasible(continuous, strict);
  const FeasiblePlan stepping = MakeFeasible(steps, strict);
  if (smooth.ok() && !stepping.ok()) {
    return continuous;
  }
  std::string why = smooth->reason;
  if (smooth.ok()) {
    double time = TotalTime(request, smooth);
    const double with_steps = TotalTime(request, stepping);
    if (time > kMostTime * with_steps && faster) {
      time = TotalTime(request, MakeFeasible(faster(continuous), strict));
    }
    if (time <= kMostTime * with_steps) {
      return continuous;
    }
    why = fmt::format("it takes {:.3g} s instead of {:.3g} s", time, with_steps);
  }
  if (steps.ok()) {
    steps.notes.push_back(
        fmt::format("the curvature steps, because no path of continuous curvature fits: {}", why));
  }
  return steps;
}

}  // namespace trackbed
