#pragma once

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Returns the station of the first point of `path` after `station` that is `distance` away from
/// the point `p`. `path` is a Path or a RampedPath.
template <typename SomePath>
double PreviewStation(const SomePath& path, const Vec2& p, double station, double distance) {
  const auto beyond = [&](double s) { return (path.At(s).pose.position() - p).norm() - distance; };
  if (beyond(station) >= 0.0) {
    return station + distance;
  }
  // A path leaves the circle of radius `distance` around `p` no earlier than a straight path would.
  // Sampling the path in steps of `distance`/8 finds its first crossing of the circle, if all radii
  // of curvature of the path exceed one step.
  const double stride = distance / 8.0;
  double inside = station;
  while (beyond(inside + stride) < 0.0) {
    if (inside + stride == inside) {
      return station + distance;  // the distance is smaller than the rounding error of the station
    }
    inside += stride;
  }
  std::uintmax_t iterations = 100;
  const auto [low, high] = boost::math::tools::toms748_solve(
      beyond, inside, inside + stride, boost::math::tools::eps_tolerance<double>(48), iterations);
  return 0.5 * (low + high);
}

/// Returns the preview angle u [rad], as PreviewAngle does. The argument `direction` is the path's
/// direction of motion at `station`.
template <typename SomePath>
double AngleTo(const SomePath& path, int direction, const Pose2& pose, double station,
               double distance) {
  const double s = PreviewStation(path, pose.position(), station, distance);
  // In reverse, the direction of motion is opposite to the heading.
  const Vec2 to_point = direction * ToLocal(pose, path.At(s).pose.position());
  return std::atan2(to_point.y(), to_point.x());
}

}  // namespace trackbed
