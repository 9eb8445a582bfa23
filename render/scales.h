#pragma once

#include <span>

namespace trackbed::render {

struct Recording;

/// Scales of a film: the largest value of the color scale, and the ends of the axes.
struct Scales {
  double end = 0;  ///< End of the run [s].
  /// Cross-track error shown by the last color of the error ribbon [m]. The scale `error` is the
  /// maximum error of the run, rounded up to 1, 2 or 5 times a power of ten, and at least 0.05 m.
  /// The scale `error` is 0 if the car follows no path or its log has no cross-track error.
  double error = 0;
  double steering = 0;   ///< Largest commanded or actual steering angle [rad], at least one degree.
  double curvature = 0;  ///< Largest planned curvature at the car's positions [rad/m].
};

/// Computes the scales of a single recorded car.
Scales ComputeScales(const Recording& recording);

/// Sets each scale of several recordings to the maximum over all recordings, so that their pictures
/// can be compared.
void ShareScales(std::span<Recording> recordings);

}  // namespace trackbed::render
