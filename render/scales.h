#pragma once

#include <span>

namespace trackbed::render {

struct Recording;

/// Scales of a film: the value of the last color and the ends of axes.
struct Scales {
  double end = 0;  ///< end of the run [s]
  /// Cross-track error of the ribbon's last color [m]: the maximum of the run, rounded up to 1, 2
  /// or 5 times a power of ten, at least 0.05 m. 0 if the car follows no path or its log has no
  /// cross-track error.
  double error = 0;
  double steering = 0;   ///< largest commanded or actual angle, at least a degree [rad]
  double curvature = 0;  ///< largest planned curvature at the car's positions [rad/m]
};

/// Scales of the recorded car alone.
Scales ComputeScales(const Recording& recording);

/// Sets the scales of recordings shown together to their maximum.
void ShareScales(std::span<Recording> recordings);

}  // namespace trackbed::render
