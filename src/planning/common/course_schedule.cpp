#include "trackbed/planning/common/course_schedule.h"

#include <algorithm>
#include <cmath>

#include "trackbed/planning/common/curvature_steps.h"

namespace trackbed {

double SharpestCurvature(const Segment& segment) {
  const double end = segment.CurvatureAt(segment.length);
  return std::abs(end) > std::abs(segment.curvature) ? end : segment.curvature;
}

SteeringSchedule CourseSchedule(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                                double speed, const std::vector<SpeedCap>& caps,
                                const std::vector<double>& stops) {
  // Length of the steering ramp for wheels that turn at standstill [m]; not zero, because the
  // steering schedule is a function of the distance. A ramp shorter than half of kMinRampLength
  // stems from rounding of the curvature, and adds no knot.
  constexpr double kMinRampLength = 1e-6;
  // Spacing of the schedule's knots, chosen so that linear interpolation reproduces the arctangent
  // of the curvature within 1e-5 rad [m].
  constexpr double kSpacing = 0.5;
  const auto steering = [&](double curvature) { return SteeringForCurvature(vehicle, curvature); };
  const std::vector<SteeringRamp> ramps = RampsOfSteps(vehicle, segments, speed, caps, stops);
  auto ramp = ramps.begin();
  std::vector<SteeringSchedule::Knot> knots;
  double begin = 0.0;
  double taken = 0.0;  // length of the steering ramp at the beginning of the piece [m]
  bool is_joined = false;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    const double end = begin + segment.length;
    double from = taken;
    double to = segment.length;
    taken = 0.0;
    bool joins = false;
    if (i + 1 < segments.size() &&
        steering(segments[i + 1].curvature) != steering(segment.CurvatureAt(segment.length))) {
      joins = true;
      if (ramp != ramps.end() && ramp->joint == end) {
        to = ramp->from - begin;
        taken = ramp->to - end;
        ++ramp;
      } else {
        to = segment.length - std::min(kMinRampLength, 0.5 * segment.length);
      }
    }
    // If two ramps meet in the middle of a piece, rounding may make `from` larger than `to`.
    from = std::min(from, to);
    const double parts = segment.sharpness == 0.0 && segment.sharpness_rate == 0.0
                             ? 1.0
                             : std::ceil(std::max(to - from, kMinRampLength) / kSpacing);
    for (double k = is_joined || i == 0 ? 0.0 : 1.0; k <= parts; k += 1.0) {
      const double d = std::lerp(from, to, k / parts);
      if (knots.empty() || begin + d > knots.back().distance + 0.5 * kMinRampLength) {
        knots.push_back({begin + d, steering(segment.CurvatureAt(d))});
      }
    }
    begin = end;
    is_joined = joins;
  }
  return SteeringSchedule::Through(std::move(knots));
}

}  // namespace trackbed
