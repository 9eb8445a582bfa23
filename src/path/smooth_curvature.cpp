#include "trackbed/path/smooth_curvature.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/bezier.h"

namespace trackbed {
namespace {

constexpr double kSpacing = 0.1;  // [m]

/// Returns the mean position of the path over a window centered at the path's start.
Vec2 MeanAtStart(const Path& path, double window) {
  using Quadrature = boost::math::quadrature::gauss<double, 10>;
  const double pieces = std::ceil(window / kSpacing);
  Vec2 sum{0.0, 0.0};
  for (double i = 0.0; i < pieces; i += 1.0) {
    const double from = window * (i / pieces - 0.5);
    const double to = window * ((i + 1.0) / pieces - 0.5);
    sum.x() += Quadrature::integrate([&](double s) { return path.At(s).pose.x; }, from, to);
    sum.y() += Quadrature::integrate([&](double s) { return path.At(s).pose.y; }, from, to);
  }
  return sum / window;
}

}  // namespace

Path SmoothCurvature(const Path& path, double window) {
  constexpr double kMaxLength = 1e6;  // upper limit of the averaging window for any path [m]
  TRACKBED_CHECK(window > 0.0 && window <= kMaxLength && path.length() > 0.0,
                 "window {}, path of {} m", window, path.length());
  for (const Segment& segment : path.segments()) {
    TRACKBED_CHECK(segment.direction == 1, "a segment of direction {}", segment.direction);
  }
  // The derivatives of the path's moving average with respect to s are differences between both
  // ends of the averaging window, divided by its length.
  const auto first_at = [&](double s) -> Vec2 {
    return (path.At(s + 0.5 * window).pose.position() - path.At(s - 0.5 * window).pose.position()) /
           window;
  };
  std::vector<CurvePoint> curve;
  double distance = 0.0;
  double yaw = path.At(0.0).pose.yaw;
  double last = 0.0;
  double last_rate = 0.0;
  for (const PathPoint& point : path.Sample(kSpacing)) {
    const Vec2 first = first_at(point.s);
    const Vec2 second = (Direction(path.At(point.s + 0.5 * window).pose.yaw) -
                         Direction(path.At(point.s - 0.5 * window).pose.yaw)) /
                        window;
    const double rate = first.norm();
    if (!curve.empty()) {
      const double middle = first_at(0.5 * (last + point.s)).norm();
      distance += (point.s - last) * (last_rate + 4.0 * middle + rate) / 6.0;
    }
    yaw += AngleDifference(std::atan2(first.y(), first.x()), yaw);
    curve.push_back({distance, yaw, CurvatureFromDerivatives(first, second)});
    last = point.s;
    last_rate = rate;
  }
  const Vec2 start = MeanAtStart(path, window);
  return {{start.x(), start.y(), curve.front().yaw}, SegmentsThrough(curve)};
}

}  // namespace trackbed
