#include "trackbed/planning/common/plan_comparison.h"

#include <cstddef>
#include <limits>

#include "trackbed/planning/common/driving_time.h"

namespace trackbed {

double PlanLength(const Plan& plan) {
  return plan.ok() ? plan.reference.path.length() : std::numeric_limits<double>::infinity();
}

bool IsDetour(const Plan& plan, const PlanRequest& request) {
  Vec2 at = request.start.position();
  double straight = 0.0;
  for (std::size_t i = 1; i < request.waypoints.size(); ++i) {
    straight += (request.waypoints[i] - at).norm();
    at = request.waypoints[i];
  }
  return PlanLength(plan) >= straight + request.vehicle.min_turning_radius();
}

bool IsShorterAndNotSlower(const Plan& plan, const Plan& best, const VehicleParams& car) {
  return plan.ok() &&
         (!best.ok() || (PlanLength(plan) + car.min_turning_radius() <= PlanLength(best) &&
                         DrivingTime(plan, car) <= DrivingTime(best, car)));
}

}  // namespace trackbed
