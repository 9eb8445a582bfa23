#pragma once

#include <span>

namespace trackbed::render {

struct Recording;

/// Scales of a film: the value of the last color, and the ends of axes.
struct Scales {
  double end = 0;  ///< End of the run [s].
  /// Cross-track error of the ribbon's last color [m]. The scale is the maximum of the run, rounded
  /// up to 1, 2 or 5 times a power of ten, and at least 0.05 m. The scale is 0 if the car follows
  /// no path or its log has no cross-track error.
  double error = 0;
  double steering = 0;   ///< Largest commanded or actual steering angle, at least one degree [rad].
  double curvature = 0;  ///< Largest planned curvature at the car's positions [rad/m].
};

/// Computes the scales of a single recorded car.
Scales ComputeScales(const Recording& recording);

/// Sets the scales of several recordings to the maximum of all, so that they can be shown together.
void ShareScales(std::span<Recording> recordings);

}  // namespace trackbed::render
