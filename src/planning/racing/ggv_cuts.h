#pragma once

#include "trackbed/planning/racing/minimum_time.h"

/// Lines along the boundary of a g-g-v diagram, and of what motor and brakes allow, for optimizers.
namespace trackbed {

/// across f_y + along a <= bound, a the acceleration and f_y >= 0 the lateral force [m/s^2].
struct GgvCut {
  double across = 0.0;
  double along = 0.0;
  double bound = 0.0;
};

enum class GgvSide { kDriving, kBraking };

/// The tangent where f_y is cos(angle) of the largest one at a speed of `squared` [m^2/s^2], of
/// length 1 as a vector (across, along in f_x).
GgvCut TyreCut(const LapLimits& limits, double squared, double angle, GgvSide side);

/// How fast the direction of the tangent turns along the boundary there [rad per m/s^2], at most 1.
double TyreCurvature(const LapLimits& limits, double squared, double angle, GgvSide side);

/// What motor or brakes allow.
GgvCut ForceCut(const LapLimits& limits, double squared, GgvSide side);

}  // namespace trackbed
