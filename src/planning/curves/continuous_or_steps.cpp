#include "src/planning/curves/continuous_or_steps.h"

#include <fmt/format.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "src/planning/curves/detours.h"
#include "src/planning/curves/route_time.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/fewer_corners.h"
#include "trackbed/planning/curves/curve_planners.h"

namespace trackbed {
namespace {

/// Returns the plan with the speeds at which the car can drive it. A plan that exceeds a limit is
/// not accepted, even if the request permits infeasible plans.
FeasiblePlan MakeDrivable(const PlanRequest& request, const Plan& plan) {
  PlanRequest strict = request;
  strict.infeasible = InfeasiblePolicy::kSlowDown;
  return MakeFeasible(plan, strict);
}

/// Adds the reason why the curvature of a plan steps.
Plan WithReason(Plan steps, const std::string& why) {
  if (steps.ok()) {
    steps.notes.push_back(fmt::format("the curvature steps, because {}", why));
  }
  return steps;
}

std::string DoesNotFit(const FeasiblePlan& smooth) {
  return "no path of continuous curvature fits: " + smooth->reason;
}

/// Returns the request to drive through the stops of a plan of curves, which may leave out
/// waypoints or have other headings than the request.
PlanRequest ThroughStopsOf(const CurveDiagnostics& found, const Path& path,
                           const PlanRequest& request) {
  std::vector<Pose2> stops;
  double station = path.length();
  for (std::size_t i = found.curves.size(); i-- > 0; station -= found.curves[i].length) {
    stops.push_back(path.At(station).pose);
  }
  PlanRequest own = request;
  own.waypoints = {request.waypoints.front()};
  own.headings = {request.start.yaw};
  for (std::size_t i = stops.size(); i-- > 0;) {
    own.waypoints.push_back(stops[i].position());
    own.headings.push_back(stops[i].yaw);
  }
  return own;
}

/// Returns whether a plan passes all waypoints of the request. If the plan leaves out waypoints,
/// adds a note.
bool PassesWaypoints(Plan& plan, std::size_t left_out, const PlanRequest& request, double time,
                     double time_of_all) {
  if (left_out == 0) {
    return true;
  }
  const auto miss = LargestWaypointMiss(plan.reference.path, request.waypoints);
  if (!miss || miss->distance > kUnnoticedShareOfWidth * request.vehicle.width) {
    return false;
  }
  plan.notes.push_back(DescribeLeftOut(
      left_out,
      fmt::format("the path through all waypoints would take {:.3g} s instead of {:.3g} s",
                  time_of_all, time),
      *miss));
  return true;
}

}  // namespace

double DrivableTime(const PlanRequest& request, const Plan& plan) {
  const FeasiblePlan drivable = MakeDrivable(request, plan);
  return drivable.ok() ? TotalTime(request, drivable) : std::numeric_limits<double>::infinity();
}

Plan DrivableOrSteps(Plan continuous, const PlanRequest& request,
                     const std::function<Plan()>& steps) {
  const FeasiblePlan smooth = MakeDrivable(request, continuous);
  return smooth.ok() ? continuous : WithReason(steps(), DoesNotFit(smooth));
}

Plan ContinuousOrSteps(Plan continuous, Plan steps, const PlanRequest& request, double most) {
  const FeasiblePlan smooth = MakeDrivable(request, continuous);
  if (!smooth.ok()) {
    return WithReason(std::move(steps), DoesNotFit(smooth));
  }
  const double time = TotalTime(request, smooth);
  const double with_steps = DrivableTime(request, steps);
  if (time <= most * with_steps) {
    return continuous;
  }
  return WithReason(std::move(steps),
                    fmt::format("a path of continuous curvature takes {:.3g} s instead of {:.3g} s",
                                time, with_steps));
}

Plan FastestCurves(Plan best, const PlanRequest& request, const std::function<Plan()>& plan_steps,
                   const std::function<Plan(const PlanRequest&)>& plan_through) {
  Plan steps = plan_steps();
  const double time = DrivableTime(request, best);
  const auto* found = steps.diagnostics.planner.GetIf<CurveDiagnostics>();
  if (!steps.ok() || found == nullptr || DrivableTime(request, steps) >= time) {
    return best;
  }
  const PlanRequest own = ThroughStopsOf(*found, steps.reference.path, request);
  Plan through = plan_through(own);
  const double own_time = DrivableTime(request, through);
  if (own_time < time && PassesWaypoints(through, request.waypoints.size() - own.waypoints.size(),
                                         request, own_time, time)) {
    best = std::move(through);
  }
  return ContinuousOrSteps(std::move(best), std::move(steps), request);
}

}  // namespace trackbed
