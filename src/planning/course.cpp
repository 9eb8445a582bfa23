#include "trackbed/planning/course.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {

std::vector<Segment> CourseSegments(const CourseOptions& options) {
  TRACKBED_CHECK(!options.segments.empty(), "a course without segments");
  std::vector<Segment> segments;
  double end = 0.0;
  for (const CoursePiece& piece : options.segments) {
    TRACKBED_CHECK(piece.length > 0.0, "a piece of {} m", piece.length);
    TRACKBED_CHECK(piece.curvature.has_value() != piece.curvature_to.has_value() &&
                       !(piece.curvature && piece.curvature_from),
                   "a piece of {} m is neither constant nor a ramp", piece.length);
    const double from = piece.curvature.value_or(piece.curvature_from.value_or(end));
    end = piece.curvature_to.value_or(from);
    segments.push_back({.length = piece.length,
                        .curvature = from,
                        .direction = 1,
                        .sharpness = (end - from) / piece.length});
  }
  return segments;
}

double SharpestCurvature(const Segment& segment) {
  const double end = segment.CurvatureAt(segment.length);
  return std::abs(end) > std::abs(segment.curvature) ? end : segment.curvature;
}

SteeringSchedule CourseSchedule(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                                double speed) {
  return CourseSchedule(vehicle, segments, SpeedProfile({{0.0, speed}}));
}

SteeringSchedule CourseSchedule(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                                const SpeedProfile& profile) {
  // Where the car stands the wheels have to turn on the spot; a schedule over the distance needs
  // some for that [m].
  constexpr double kLeast = 1e-3;
  constexpr double kSpacing = 0.5;  // [m]; atan bends by less than 1e-5 rad within
  const auto steering = [&](double curvature) { return SteeringForCurvature(vehicle, curvature); };
  std::vector<SteeringSchedule::Knot> knots;
  double begin = 0.0;
  double room_before = 0.0;  // how much of the piece the ramp of the step before it takes
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    double room_after = 0.0;
    if (i + 1 < segments.size()) {
      const Segment& next = segments[i + 1];
      const double step =
          std::abs(steering(next.curvature) - steering(segment.CurvatureAt(segment.length)));
      const double speed = profile.SpeedAt(begin + segment.length);
      const double half = 0.5 * speed * step / vehicle.steering_rate;
      room_after = std::min(
          {step > 0.0 ? std::max(half, kLeast) : 0.0, 0.4 * segment.length, 0.4 * next.length});
    }
    const double from = room_before;
    const double to = segment.length - room_after;
    const double parts = segment.sharpness == 0.0 ? 1.0 : std::ceil((to - from) / kSpacing);
    for (double k = from > 0.0 || i == 0 ? 0.0 : 1.0; k <= parts; k += 1.0) {
      const double d = std::lerp(from, to, k / parts);
      knots.push_back({begin + d, steering(segment.CurvatureAt(d))});
    }
    begin += segment.length;
    room_before = room_after;
  }
  return SteeringSchedule::Through(std::move(knots));
}

}  // namespace trackbed
