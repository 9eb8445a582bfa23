#pragma once

#include <optional>

#include "trackbed/control/signal.h"
#include "trackbed/control/speed_control_options.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/path/reference.h"

namespace trackbed {

/// Returns the commanded acceleration [m/s^2] of a car that follows the speed profile `profile`.
/// The car is at station `s` and has the speed `speed` along the path (negative if the car rolls
/// back). The command is the sum of the profile's mean acceleration over the coming control period
/// and gain times the speed error. The command is clamped to [-2 deceleration, acceleration]. In
/// the control period in which the profile ends at rest, the profile's acceleration replaces the
/// mean acceleration.
///
/// If the profile brakes more than 1.1 times as hard as `deceleration`, the lower bound is extended
/// to 1.05 times the profile's deceleration. The upper bound is extended in the same way if the
/// profile accelerates more than 1.1 times as hard as `acceleration`. Past the end of a profile
/// that ends at rest, the car brakes as hard as the end of the profile, at least at `deceleration`.
/// Braking never exceeds `max_deceleration` [m/s^2], the limit of the car on its road (0: unknown).
double SpeedControl(const SpeedControlOptions& options, const SpeedProfile& profile, double s,
                    double speed, double period, double max_deceleration = 0.0);

/// Returns the commanded acceleration [m/s^2] at `time` [s] if the options prescribe a speed over
/// time or a braking that has begun; otherwise nullopt. Before the braking begins, the car follows
/// `over_time` (SpeedAlong). The options `acceleration` and `deceleration` do not limit this
/// command.
std::optional<double> TimedSpeedControl(const SpeedControlOptions& options, double time,
                                        double speed, double period);

/// Returns whether the car coasts at `time` [s]: the braking of the options has begun, and its
/// deceleration is 0.
bool Coasts(const SpeedControlOptions& options, double time);

/// Returns the commanded acceleration [m/s^2] of a car with the speed `speed`, whose wanted speed
/// changes from wanted(x) to wanted(x + ahead) within `period`. The command is the change of the
/// wanted speed divided by the period, plus gain [1/s] times the speed error. A car without speed
/// error that follows commands exactly reaches the speed wanted(x + ahead).
double SpeedAlong(const Signal& wanted, double x, double ahead, double gain, double speed,
                  double period);

}  // namespace trackbed
