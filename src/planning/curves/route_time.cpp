#include "src/planning/curves/route_time.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "trackbed/planning/common/driving_time.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/dubins.h"

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

double LeastForwardTime(const PlanRequest& request, double radius) {
  const std::vector<Pose2> stops = PlannedStops(request);
  double length = 0.0;
  for (std::size_t i = 1; i < stops.size(); ++i) {
    length += Dubins(stops[i - 1], stops[i], radius).length;
  }
  return length / std::max(request.speed.speed, request.start_speed);
}

}  // namespace trackbed
