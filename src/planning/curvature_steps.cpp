#include "trackbed/planning/curvature_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trackbed {

double StepSpeed(const VehicleParams& vehicle, double curvature_before, double curvature_after) {
  const double steering = std::abs(SteeringForCurvature(vehicle, curvature_after) -
                                   SteeringForCurvature(vehicle, curvature_before));
  const double step = std::abs(curvature_after - curvature_before);
  return steering == 0.0
             ? std::numeric_limits<double>::infinity()
             : vehicle.steering_rate * std::sqrt(24.0 * kStepDeviation / step) / steering;
}

std::vector<SpeedCap> CapsOfSteps(const VehicleParams& vehicle,
                                  const std::vector<Segment>& segments, double min_speed) {
  std::vector<SpeedCap> caps;
  double joint = 0.0;
  Segment before;  // straight
  for (const Segment& segment : segments) {
    const double curvature = before.CurvatureAt(before.length);
    const double turned = std::abs(SteeringForCurvature(vehicle, segment.curvature) -
                                   SteeringForCurvature(vehicle, curvature));
    const bool cusp = joint > 0.0 && before.direction != segment.direction;
    if (turned > 0.0 && !cusp) {
      const double room =
          joint > 0.0 ? std::min(before.length, segment.length) : 2.0 * segment.length;
      const double speed = std::max(std::min(StepSpeed(vehicle, curvature, segment.curvature),
                                             vehicle.steering_rate * room / turned),
                                    min_speed);
      const double half = 0.5 * speed * turned / vehicle.steering_rate;
      caps.push_back({std::max(joint - half, 0.0), joint + half, speed});
    }
    joint += segment.length;
    before = segment;
  }
  return caps;
}

}  // namespace trackbed
