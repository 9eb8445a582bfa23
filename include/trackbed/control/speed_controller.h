#pragma once

#include "trackbed/path/reference.h"

namespace trackbed {

struct SpeedControlOptions {
  double acceleration = 1.0;  ///< [m/s^2], > 0; also shapes the plan's speed profile
  double deceleration = 1.5;  ///< [m/s^2], > 0; likewise
  double gain = 2.0;          ///< [1/s], on the speed error
};

/// Wanted acceleration [m/s^2] of a car at station `s` with `speed` (>= 0, along the path) that
/// follows `profile`: the profile's own acceleration at the middle of the coming `period`, plus
/// gain times the speed error, within [-2 deceleration, acceleration]. After the end of a profile
/// that ends at rest it brakes.
double SpeedControl(const SpeedControlOptions& options, const SpeedProfile& profile, double s,
                    double speed, double period);

}  // namespace trackbed
