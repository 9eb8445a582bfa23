#include "trackbed/planning/common/curvature_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trackbed {
namespace {

/// A joint between two path pieces at which the steering angle changes by a step.
struct Step {
  double joint;     // Station of the joint [m].
  double before;    // Curvature of the path just before the joint [1/m].
  double after;     // Curvature of the path just after the joint [1/m].
  double steering;  // Magnitude of the change of the steering angle between both pieces [rad].
  // Length available for the steering ramp, equal to that of the shorter adjacent piece [m].
  double room;
  bool cusp;  // Whether the direction of motion changes at the joint.
};

std::vector<Step> CurvatureSteps(const VehicleParams& vehicle,
                                 const std::vector<Segment>& segments) {
  std::vector<Step> steps;
  double joint = 0.0;
  for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
    const Segment& a = segments[i];
    const Segment& b = segments[i + 1];
    joint += a.length;
    const double before = a.CurvatureAt(a.length);
    const double steering = std::abs(SteeringForCurvature(vehicle, b.curvature) -
                                     SteeringForCurvature(vehicle, before));
    if (steering > 0.0) {
      steps.push_back({joint, before, b.curvature, steering, std::min(a.length, b.length),
                       a.direction != b.direction});
    }
  }
  return steps;
}

/// Returns the speed at which the steering ramp is as long as the shorter of the adjacent pieces.
/// The steering ramp is centered on the joint of two pieces, so the ramp covers at most half of
/// each piece.
double RampSpeedLimit(const VehicleParams& vehicle, const Step& step) {
  return vehicle.steering_rate * step.room / step.steering;
}

/// Returns whether a sorted list contains a station, within rounding.
bool ContainsStation(const std::vector<double>& sorted, double s) {
  constexpr double kEqualityTolerance = 1e-9;  // [m]
  const auto station = std::upper_bound(sorted.begin(), sorted.end(), s - kEqualityTolerance);
  return station != sorted.end() && *station < s + kEqualityTolerance;
}

/// Returns the lowest speed of the caps at each step; infinite at steps without a cap. The steps
/// are sorted by their joints.
std::vector<double> CapsAtSteps(const std::vector<Step>& steps, const std::vector<SpeedCap>& caps) {
  std::vector<double> speeds(steps.size(), std::numeric_limits<double>::infinity());
  for (const SpeedCap& cap : caps) {
    const auto first =
        std::lower_bound(steps.begin(), steps.end(), cap.from,
                         [](const Step& step, double station) { return step.joint < station; });
    for (auto i = static_cast<std::size_t>(first - steps.begin());
         i < steps.size() && steps[i].joint <= cap.to; ++i) {
      speeds[i] = std::min(speeds[i], cap.speed);
    }
  }
  return speeds;
}

}  // namespace

double StepSpeed(const VehicleParams& vehicle, double curvature_before, double curvature_after) {
  const double steering = std::abs(SteeringForCurvature(vehicle, curvature_after) -
                                   SteeringForCurvature(vehicle, curvature_before));
  const double step = std::abs(curvature_after - curvature_before);
  return steering == 0.0
             ? std::numeric_limits<double>::infinity()
             : vehicle.steering_rate * std::sqrt(24.0 * kStepDeviation / step) / steering;
}

std::vector<SteeringRamp> RampsOfSteps(const VehicleParams& vehicle,
                                       const std::vector<Segment>& segments, double speed,
                                       const std::vector<SpeedCap>& caps,
                                       const std::vector<double>& stops) {
  std::vector<SteeringRamp> ramps;
  const std::vector<Step> steps = CurvatureSteps(vehicle, segments);
  const std::vector<double> capped = CapsAtSteps(steps, caps);
  std::vector<double> sorted_stops = stops;
  std::sort(sorted_stops.begin(), sorted_stops.end());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    if (step.cusp || ContainsStation(sorted_stops, step.joint)) {
      continue;
    }
    const double at = std::min({speed, RampSpeedLimit(vehicle, step), capped[i]});
    const double half = 0.5 * at * step.steering / vehicle.steering_rate;
    ramps.push_back({step.joint, step.joint - half, step.joint + half, at, step.steering});
  }
  return ramps;
}

StepSpeeds PlanSteps(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                     double min_speed) {
  StepSpeeds speeds;
  for (const Step& step : CurvatureSteps(vehicle, segments)) {
    const double room = RampSpeedLimit(vehicle, step);
    if (step.cusp) {
      continue;
    }
    if (room < min_speed) {
      speeds.stops.push_back(step.joint);
      continue;
    }
    const double speed =
        std::min(std::max(StepSpeed(vehicle, step.before, step.after), min_speed), room);
    const double half = 0.5 * speed * step.steering / vehicle.steering_rate;
    speeds.caps.push_back({step.joint - half, step.joint + half, speed});
  }
  return speeds;
}

}  // namespace trackbed
