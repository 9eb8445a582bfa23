#include "python/src/joined_path.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/planning/frenet/polynomial.h"

// Symbols: s is the station on the given path, kappa its curvature, e(s) the distance of the joined
// path to the left of the given path. The joined path p(s) + n(s) e(s) has, with a = 1 - kappa e,
//   length    dl/ds = sqrt(a^2 + e'^2)
//   yaw       yaw(s) + atan2(e', a)
//   curvature (a (kappa a + e'') + e' (kappa' e + 2 kappa e'))/(a^2 + e'^2)^(3/2).
namespace trackbed::python {
namespace {

constexpr int kSteps = 200;

double Largest(const Polynomial& offset, double length) {
  double largest = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    largest = std::max(largest, std::abs(offset.At(length * i / kSteps)));
  }
  return largest;
}

/// The joined path at one station of the given path.
struct JoinedPoint {
  double rate = 1.0;  // Length of the joined path per length of the given path.
  double yaw = 0.0;
  double curvature = 0.0;
};

JoinedPoint PointAt(const Path& path, const Polynomial& offset, double s) {
  const PathPoint at = path.At(s);
  const double e = offset.At(s);
  const double slope = offset.At(s, 1);
  const double a = 1.0 - at.curvature * e;
  const double rate = std::hypot(a, slope);
  const double turn = a * (at.curvature * a + offset.At(s, 2)) +
                      slope * (at.sharpness * e + 2.0 * at.curvature * slope);
  return {rate, at.pose.yaw + std::atan2(slope, a), turn / (rate * rate * rate)};
}

/// Returns the joined path over [0, length]; nullopt if it has a curvature above `limit`.
std::optional<std::vector<CurvePoint>> Join(const Path& path, const Polynomial& offset,
                                            double length, double limit) {
  std::vector<CurvePoint> points;
  double along = 0.0;
  const double step = length / kSteps;
  for (int i = 0; i <= kSteps; ++i) {
    const double s = step * i;
    const JoinedPoint point = PointAt(path, offset, s);
    if (!(std::abs(point.curvature) <= limit)) {
      return std::nullopt;
    }
    points.push_back({along, point.yaw, point.curvature});
    // Simpson's rule for the length to the next point.
    const double middle = PointAt(path, offset, s + 0.5 * step).rate;
    const double end = PointAt(path, offset, s + step).rate;
    along += step / 6.0 * (point.rate + 4.0 * middle + end);
  }
  return points;
}

}  // namespace

Path JoinedToStart(const Path& path, const PlanRequest& request, double max_deviation) {
  const PathPoint first = path.At(0.0);
  const double turn = AngleDifference(request.start.yaw, first.pose.yaw);
  const double needed = request.start_speed > 0.0
                            ? CurvatureForSteering(request.vehicle, request.start_steering)
                            : first.curvature;
  if (first.direction < 0 || std::abs(turn) >= 1.0 || (turn == 0.0 && needed == first.curvature)) {
    return path;
  }
  const double slope = std::tan(turn);
  const double bend = needed * std::pow(1.0 + slope * slope, 1.5) - first.curvature -
                      2.0 * first.curvature * slope * slope;
  const auto offset = [&](double length) {
    return QuinticBetween({0.0, slope, bend}, {0.0, 0.0, 0.0}, length);
  };
  double low = 0.0;
  double high = SplitIntoLegs(path).front().to;
  if (Largest(offset(high), high) > max_deviation) {
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (Largest(offset(middle), middle) > max_deviation ? high : low) = middle;
    }
    high = low;
  }
  const double limit = 1.0 / request.vehicle.min_turning_radius();
  const auto points = high > 0.0 ? Join(path, offset(high), high, limit) : std::nullopt;
  if (!points) {
    return path;
  }
  std::vector<Segment> segments = SegmentsThrough(*points);
  const std::vector<Segment> rest = path.Cut({high, path.length()});
  segments.insert(segments.end(), rest.begin(), rest.end());
  Pose2 start = first.pose;
  start.yaw += turn;
  return {start, std::move(segments)};
}

}  // namespace trackbed::python
