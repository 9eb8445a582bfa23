#pragma once

#include <optional>

#include "trackbed/control/signal.h"
#include "trackbed/control/speed_control_options.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/path/reference.h"

namespace trackbed {

/// Returns the commanded acceleration [m/s^2] of a car that follows the speed profile `profile`.
/// The car is at station `s` and has the speed `speed` along the path (negative if the car rolls
/// back). The commanded acceleration is the sum of the profile's mean acceleration over the coming
/// control period and the gain times the speed error. The commanded acceleration is clamped to the
/// range from -2 times `deceleration` to `acceleration`. In the control period in which the profile
/// ends at rest, the profile's acceleration is used instead of its mean over the period.
///
/// If the profile brakes more than 1.1 times as hard as `deceleration`, the lower bound of the
/// command is extended to 1.05 times the profile's deceleration. If the profile accelerates more
/// than 1.1 times as hard as `acceleration`, the upper bound of the command is extended to 1.05
/// times the profile's acceleration. Beyond the end of a profile that ends at rest, the car brakes
/// with `deceleration`. If the end of the profile brakes more than 1.1 times as hard as
/// `deceleration`, the car brakes as hard as the end of the profile. The commanded deceleration
/// never exceeds `max_deceleration` [m/s^2], the maximum deceleration of the car on its road (0:
/// unknown).
double SpeedControl(const SpeedControlOptions& options, const SpeedProfile& profile, double s,
                    double speed, double period, double max_deceleration = 0.0);

/// Returns the commanded acceleration [m/s^2] at `time` [s] if the options prescribe a speed over
/// time, or a braking that has already begun; otherwise nullopt. Before the braking begins, the car
/// follows the prescribed speed `over_time` (SpeedAlong). A prescribed command is not limited by
/// the options `acceleration` and `deceleration`.
std::optional<double> TimedSpeedControl(const SpeedControlOptions& options, double time,
                                        double speed, double period);

/// Whether the options contain a braking that has begun at `time` [s] or before.
bool BrakingHasBegun(const SpeedControlOptions& options, double time);

/// Whether the car coasts at `time` [s], which is the case if the options contain a braking that
/// has begun and has the deceleration 0.
bool Coasts(const SpeedControlOptions& options, double time);

/// Returns the commanded acceleration [m/s^2] of a car with the speed `speed`, whose wanted speed
/// changes from wanted(x) to wanted(x + ahead) within `period`. The commanded acceleration is the
/// change of the wanted speed divided by the period, plus `gain` [1/s] times the speed error. A car
/// that has no speed error and follows commands exactly reaches the speed wanted(x + ahead) at the
/// end of the period.
double SpeedAlong(const Signal& wanted, double x, double ahead, double gain, double speed,
                  double period);

}  // namespace trackbed
