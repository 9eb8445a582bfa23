#pragma once

#include "trackbed/planning/racing/minimum_time.h"

/// Tangents to the boundary of a g-g-v diagram, and the limits of motor and brakes, for optimizers.
namespace trackbed {

/// The inequality `across` f_y + `along` a <= `bound`, for the acceleration a and the lateral force
/// f_y >= 0 [m/s^2].
struct GgvCut {
  double across = 0.0;
  double along = 0.0;
  double bound = 0.0;
};

enum class GgvSide { kDriving, kBraking };

/// Tangent at the point where f_y is cos(angle) times its maximum. The squared speed is `squared`
/// [m^2/s^2]. The tangent's normal vector (across, along in f_x) has length 1.
GgvCut TyreCut(const LapLimits& limits, double squared, double angle, GgvSide side);

/// Rate at which the direction of the tangent from TyreCut turns along the boundary [rad per
/// m/s^2], at most 1.
double TyreCurvature(const LapLimits& limits, double squared, double angle, GgvSide side);

/// Limit of the motor or of the brakes.
GgvCut ForceCut(const LapLimits& limits, double squared, GgvSide side);

}  // namespace trackbed
