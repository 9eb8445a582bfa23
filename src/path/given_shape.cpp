#include "src/path/given_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/path/points_to_fit.h"
#include "trackbed/core/angle.h"
#include "trackbed/geometry/pose.h"

// Converts points with a planner's headings and curvatures to a path. Between two points, the turn
// of the car and the length of the step determine the mean curvature. The segment between two
// points gets a monotonic quadratic curvature profile with this mean curvature, if possible. If the
// curvature is constant on both sides of the step between two points, it jumps within the step; the
// mean curvature determines where. After a cusp, the curvature of the first segment is linear,
// because the curvature given at a cusp may belong to the leg before the cusp. If no curvature
// profile has a step's mean curvature, the given headings and curvatures do not agree with the
// points.

namespace trackbed {
namespace {

/// Curvature difference that is regarded as a rounding error [1/m].
constexpr double kSameCurvature = 1e-8;

class GivenShape {
 public:
  explicit GivenShape(const PathPoints& given) : given_(given) {
    for (const double curvature : given.curvature) {
      largest_ = std::max(largest_, std::abs(curvature));
    }
  }

  /// Returns the segments from a point of a leg to the next point; empty if no curvature profile
  /// fits.
  [[nodiscard]] std::vector<Segment> Step(const Leg& leg, std::size_t i) const {
    constexpr double kMaxTurn = 1.0;    // Largest turn of a step [rad].
    constexpr int kIterations = 5;      // Each iteration reduces the error by a factor of turn^2.
    constexpr double kMaxError = 1e-4;  // Position error / step length.
    const Pose2 from = PoseAt(i);
    const Pose2 to = PoseAt(i + 1);
    const double turn = leg.direction * AngleDifference(to.yaw, from.yaw);
    if (std::abs(turn) > kMaxTurn) {
      return {};
    }
    double length = (to.position() - from.position()).norm();
    for (int k = 0; k <= kIterations; ++k) {
      std::vector<Segment> segments = Shape(leg, i, length, turn);
      if (segments.empty()) {
        return {};
      }
      const Path path(from, segments);
      const Vec2 error = to.position() - path.At(path.length()).pose.position();
      if (k == kIterations) {
        return error.norm() <= kMaxError * length ? std::move(segments) : std::vector<Segment>{};
      }
      length += leg.direction * error.dot(Direction(to.yaw));
      if (!(length > kEqualityTolerance)) {
        return {};
      }
    }
    return {};
  }

 private:
  [[nodiscard]] Pose2 PoseAt(std::size_t i) const {
    return {given_.points[i].x(), given_.points[i].y(), given_.yaw[i]};
  }

  /// Returns whether the curvature jumps from one constant to another between two points.
  [[nodiscard]] bool Jumps(const Leg& leg, std::size_t i) const {
    // Largest change of the curvature on the steps beside a curvature jump, as a fraction of the
    // jump.
    constexpr double kFlat = 0.01;
    const std::vector<double>& curvature = given_.curvature;
    const double flat = kFlat * std::abs(curvature[i + 1] - curvature[i]);
    // Do not compare the curvature given at the first point, which may belong to the leg before the
    // cusp.
    return (i <= leg.first + 1 || std::abs(curvature[i] - curvature[i - 1]) <= flat) &&
           (i + 1 == leg.last || std::abs(curvature[i + 2] - curvature[i + 1]) <= flat);
  }

  /// Returns segments of the total length `length` [m] that turn by `turn` [rad]; empty if no
  /// curvature profile fits.
  [[nodiscard]] std::vector<Segment> Shape(const Leg& leg, std::size_t i, double length,
                                           double turn) const {
    // Tolerance of the mean curvature, as a fraction of the largest curvature.
    constexpr double kRounding = 1e-3;
    const double a = given_.curvature[i];
    const double b = given_.curvature[i + 1];
    const double mean = turn / length;
    const double slack = kRounding * largest_;
    const double beside = mean - 0.5 * (a + b);
    for (const double own : {a, b}) {
      // The given curvature at a cusp may belong to the leg on the other side of the cusp.
      const bool is_end = i == leg.first || i + 1 == leg.last;
      if (std::abs(mean - own) <= kSameCurvature && (is_end || Jumps(leg, i))) {
        return {{length, own, leg.direction}};
      }
    }
    if (i == leg.first && i > 0) {
      // Accept a linear curvature that changes on this step about as much as on the next step.
      constexpr double kMaxRatio = 1.5;
      const double before = 2.0 * mean - b;
      const double next =
          i + 1 < leg.last ? std::abs(given_.curvature[i + 2] - b) : std::abs(largest_ - b);
      if (std::abs(before - b) <= kMaxRatio * next + slack) {
        return {{length, before, leg.direction, (b - before) / length}};
      }
    }
    const bool is_between = mean >= std::min(a, b) - slack && mean <= std::max(a, b) + slack;
    if (is_between && std::abs(b - a) > slack && Jumps(leg, i)) {
      const double after = std::clamp((mean - a) / (b - a), 0.0, 1.0) * length;
      std::vector<Segment> segments;
      for (const auto& [own_length, own] : {std::pair(length - after, a), std::pair(after, b)}) {
        if (own_length > kEqualityTolerance) {
          segments.push_back({own_length, own, leg.direction});
        }
      }
      return segments;
    }
    // Return no segments if no monotonic quadratic curvature profile has the mean curvature of the
    // step.
    if (std::abs(beside) > std::abs(b - a) / 6.0 + slack) {
      return {};
    }
    return {{length, a, leg.direction, (6.0 * mean - 4.0 * a - 2.0 * b) / length,
             6.0 * (a + b - 2.0 * mean) / (length * length)}};
  }

  const PathPoints& given_;
  double largest_ = 0.0;  // [1/m]
};

/// Appends a segment to the list. If the new and the last segment are parts of one arc or line,
/// Append merges the two segments.
void Append(std::vector<Segment>& segments, const Segment& segment) {
  const auto is_arc = [](const Segment& own) {
    return std::abs(own.CurvatureAt(own.length) - own.curvature) <= kSameCurvature &&
           std::abs(own.CurvatureAt(0.5 * own.length) - own.curvature) <= kSameCurvature;
  };
  if (!segments.empty()) {
    Segment& last = segments.back();
    if (last.direction == segment.direction && is_arc(last) && is_arc(segment) &&
        std::abs(last.curvature - segment.curvature) <= kSameCurvature) {
      last = {last.length + segment.length, last.curvature, last.direction};
      return;
    }
  }
  segments.push_back(segment);
}

}  // namespace

std::optional<FittedPath> FollowGiven(const PathPoints& given, const std::vector<Leg>& legs,
                                      const PathFitOptions& options) {
  if (given.yaw.empty() || given.curvature.empty() || options.fit != PathFit::kSpline ||
      options.closed || options.resample) {
    return std::nullopt;
  }
  const GivenShape shape(given);
  FittedPath followed;
  std::vector<Segment> segments;
  std::vector<double>& stations = followed.stations;
  stations.push_back(0.0);
  for (const Leg& leg : legs) {
    for (std::size_t i = leg.first; i < leg.last; ++i) {
      stations.push_back(stations.back());
      if ((given.points[i + 1] - given.points[i]).norm() <= kEqualityTolerance) {
        ++followed.repeated;
        continue;
      }
      const std::vector<Segment> step = shape.Step(leg, i);
      if (step.empty()) {
        return std::nullopt;
      }
      for (const Segment& segment : step) {
        stations.back() += segment.length;
        Append(segments, segment);
      }
    }
  }
  if (segments.empty()) {
    return std::nullopt;
  }
  followed.path =
      Path({given.points[0].x(), given.points[0].y(), given.yaw[0]}, std::move(segments));
  for (std::size_t i = 0; i < stations.size(); ++i) {
    stations[i] = std::min(stations[i], followed.path.length());
    const Vec2 at = followed.path.At(stations[i]).pose.position();
    if ((at - given.points[i]).norm() > options.max_deviation) {
      return std::nullopt;
    }
  }
  stations.back() = followed.path.length();
  return followed;
}

}  // namespace trackbed
