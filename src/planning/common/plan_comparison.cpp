#include "trackbed/planning/common/plan_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "trackbed/planning/common/driving_time.h"

namespace trackbed {

double PlanLength(const Plan& plan) {
  return plan.ok() ? plan.reference.path.length() : std::numeric_limits<double>::infinity();
}

double ExtraLength(const Plan& plan, const PlanRequest& request) {
  Vec2 at = request.start.position();
  double straight = 0.0;
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    straight += (request.waypoints[i] - at).norm();
    at = request.waypoints[i];
  }
  return PlanLength(plan) - straight;
}

bool IsDetour(const Plan& plan, const PlanRequest& request) {
  return ExtraLength(plan, request) >= request.vehicle.min_turning_radius();
}

bool IsShorterAndNotSlower(const Plan& plan, const Plan& best, const VehicleParams& car) {
  return plan.ok() &&
         (!best.ok() || (PlanLength(plan) + car.min_turning_radius() <= PlanLength(best) &&
                         DrivingTime(plan, car) <= DrivingTime(best, car)));
}

namespace {

/// Returns the request without the waypoints that a car reaches long after it could have stopped,
/// so that the start speed does not change the path to these waypoints.
PlanRequest UpToStoppingPlace(const PlanRequest& request) {
  // The legs after the stopping place leave room for curves that begin before the waypoints.
  constexpr std::size_t kFurtherLegs = 2;
  const double stopping =
      0.5 * request.start_speed * request.start_speed / request.speed.deceleration;
  std::size_t last = 1;
  double straight = 0.0;
  for (; last < request.waypoints.size() && straight < stopping; ++last) {
    straight += (request.waypoints[last] - request.waypoints[last - 1]).norm();
  }
  const std::size_t count = std::min(request.waypoints.size(), last + kFurtherLegs);
  PlanRequest own = request;
  own.waypoints.resize(count);
  if (!own.headings.empty()) {
    own.headings.resize(count);
  }
  return own;
}

}  // namespace

void NoteDetourOfRollingStart(const PlanRequest& request, Plan& detour,
                              const std::function<Plan(const PlanRequest&)>& plan) {
  if (!detour.ok() || request.start_speed == 0.0 || !IsDetour(detour, request)) {
    return;
  }
  PlanRequest at_rest = UpToStoppingPlace(request);
  if (at_rest.waypoints.size() < request.waypoints.size()) {
    const Plan rolling = plan(at_rest);
    at_rest.start_speed = 0.0;
    if (!IsShorterAndNotSlower(plan(at_rest), rolling, request.vehicle)) {
      return;
    }
  }
  at_rest = request;
  at_rest.start_speed = 0.0;
  const Plan shorter = plan(at_rest);
  if (IsShorterAndNotSlower(shorter, detour, request.vehicle)) {
    detour.notes.push_back(
        fmt::format("the path is {:.4g} m long, because the car starts at {:.3g} m/s; with "
                    "mission.start.speed: 0, it is {:.4g} m long",
                    PlanLength(detour), request.start_speed, PlanLength(shorter)));
  }
}

}  // namespace trackbed
