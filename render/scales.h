#pragma once

#include <span>

namespace trackbed::render {

struct Recording;

/// Scales of a film: the maximum of the color scale, and the ends of the chart's axes.
struct Scales {
  double end = 0;  ///< End of the run [s].
  /// Cross-track error at the end of the error ribbon's color scale [m]. The scale `error` is the
  /// run's maximum error, rounded up to 1, 2 or 5 times a power of ten, and at least 0.05 m. The
  /// scale `error` is 0 if the car follows no path or its log has no cross-track error.
  double error = 0;
  /// Largest commanded or actual steering angle of the run [rad], at least one degree.
  double steering = 0;
  double curvature = 0;  ///< Largest planned curvature at the positions of the car [rad/m].
};

/// Computes the scales of a single recorded car.
Scales ComputeScales(const Recording& recording);

/// Sets each scale of several recordings to the maximum over these recordings, so that their frames
/// can be compared.
void ShareScales(std::span<Recording> recordings);

}  // namespace trackbed::render
