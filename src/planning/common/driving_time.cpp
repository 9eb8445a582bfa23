#include "trackbed/planning/common/driving_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace trackbed {

double SteeringTime(const VehicleParams& vehicle, const Segment& before, const Segment& after) {
  const double steering =
      std::abs(SteeringForCurvature(vehicle, after.curvature) -
               SteeringForCurvature(vehicle, before.CurvatureAt(before.length)));
  return steering / vehicle.steering_rate;
}

double DrivingTime(const Plan& plan, const VehicleParams& vehicle) {
  const Path& path = plan.reference.path;
  const std::vector<Segment>& segments = path.segments();
  const auto stops = [&](double station) {
    constexpr double kSameStation = 1e-6;  // [m]
    return std::any_of(plan.stops.begin(), plan.stops.end(),
                       [&](double stop) { return std::abs(stop - station) < kSameStation; });
  };
  double time = plan.Duration();
  double station = 0.0;
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Segment& before = segments[i - 1];
    station += before.length;
    if (before.direction != segments[i].direction || stops(station)) {
      time += SteeringTime(vehicle, before, segments[i]);
    }
  }
  return time;
}

}  // namespace trackbed
