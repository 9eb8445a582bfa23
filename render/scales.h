#pragma once

#include <span>

namespace trackbed::render {

struct Recording;

/// What the last color and the ends of the axes in a film stand for.
struct Scales {
  double end = 0;  ///< of the run [s]
  /// Distance from the path of the ribbon's last color [m]: the largest of the run, rounded up
  /// to 1, 2 or 5 times a power of ten, and at least 0.05 m. 0 when the car follows no path or its
  /// log does not say how far from it it is.
  double error = 0;
  double steering = 0;   ///< largest commanded or actual angle, at least a degree [rad]
  double curvature = 0;  ///< largest planned one where the car was [rad/m]
};

/// Of the recorded car alone.
Scales ComputeScales(const Recording& recording);

/// Gives recordings that are shown together the largest of their scales.
void ShareScales(std::span<Recording> recordings);

}  // namespace trackbed::render
