#pragma once

#include "trackbed/planning/racing/minimum_time.h"

/// Linear inequalities for optimizers, which represent tangents to the boundary of a g-g-v diagram
/// and the limits of motor and brakes.
namespace trackbed {

/// Represents the inequality `across` f_y + `along` a <= `bound`, where a is the acceleration and
/// f_y >= 0 the lateral force per mass [m/s^2].
struct GgvCut {
  double across = 0.0;
  double along = 0.0;
  double bound = 0.0;
};

enum class GgvSide { kDriving, kBraking };

/// Returns the tangent to the tyres' boundary at the point where f_y is cos(angle) times its
/// maximum. The argument `squared` is the squared speed [m^2/s^2]. The tangent's normal vector in
/// the (f_y, f_x) plane has length 1.
GgvCut TyreCut(const LapLimits& limits, double squared, double angle, GgvSide side);

/// Returns the rate at which the tangent's direction turns along the boundary [rad per m/s^2], at
/// most 1.
double TyreCurvature(const LapLimits& limits, double squared, double angle, GgvSide side);

/// Returns the inequality for the limit of the motor (kDriving) or of the brakes (kBraking).
GgvCut ForceCut(const LapLimits& limits, double squared, GgvSide side);

}  // namespace trackbed
