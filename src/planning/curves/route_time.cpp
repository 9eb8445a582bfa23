#include "src/planning/curves/route_time.h"

#include <cmath>
#include <limits>

#include "trackbed/planning/common/driving_time.h"

namespace trackbed {

double TimeBeforeStart(const PlanRequest& request, double curvature) {
  const double turn = SteeringForCurvature(request.vehicle, curvature) - request.start_steering;
  return request.start_speed > 0.0 ? 0.0 : std::abs(turn) / request.vehicle.steering_rate;
}

double TotalTime(const PlanRequest& request, const Plan& plan) {
  if (!plan.ok() || plan.reference.path.segments().empty()) {
    return std::numeric_limits<double>::infinity();
  }
  return DrivingTime(plan, request.vehicle) +
         TimeBeforeStart(request, plan.reference.path.segments().front().curvature);
}

}  // namespace trackbed
