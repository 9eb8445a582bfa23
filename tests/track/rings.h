#pragma once

#include <cmath>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/track/track.h"

namespace trackbed {

/// Returns the points of a counterclockwise elliptic track around the origin. The half axes are `a`
/// along x and `b` along y [m]. The points are evenly spaced in the parameter of the ellipse,
/// beginning at (a, 0).
inline std::vector<TrackPoint> EllipsePoints(double a, double b, int count, double right,
                                             double left) {
  std::vector<TrackPoint> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * i / count;
    points.push_back({{a * std::cos(angle), b * std::sin(angle)}, right, left});
  }
  return points;
}

inline std::vector<TrackPoint> RingPoints(double radius, int count, double right, double left) {
  return EllipsePoints(radius, radius, count, right, left);
}

}  // namespace trackbed
