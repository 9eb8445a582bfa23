#pragma once

#include <optional>

#include "trackbed/control/signal.h"
#include "trackbed/control/speed_control_options.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/path/reference.h"

namespace trackbed {

/// Commanded acceleration [m/s^2] of a car that follows `profile`, at station `s` with `speed`
/// (along the path; negative if the car rolls back). The command is the mean acceleration that
/// reaches the profile's speed at the end of the coming `period`, plus gain times the speed error.
/// The command is clamped to [-2 deceleration, acceleration]. In the period in which the profile
/// comes to rest, the command is the profile's acceleration.
///
/// If the profile brakes more than 1.1 times as hard as `deceleration`, the lower bound is extended
/// to 1.05 times the profile's deceleration. The upper bound is extended in the same way if the
/// profile accelerates more than 1.1 times as hard as `acceleration`. Past the end of a profile
/// that ends at rest, the car brakes as hard as the end of the profile, at least at `deceleration`.
/// Braking never exceeds `max_deceleration` [m/s^2], the limit of the car on its road (0: unknown).
double SpeedControl(const SpeedControlOptions& options, const SpeedProfile& profile, double s,
                    double speed, double period, double max_deceleration = 0.0);

/// Commanded acceleration [m/s^2] at `time` [s] if the options prescribe the speed over time.
/// Before the braking begins, the car follows `over_time` (SpeedAlong). Only the car limits the
/// acceleration. Nullopt if the options do not prescribe the speed.
std::optional<double> TimedSpeedControl(const SpeedControlOptions& options, double time,
                                        double speed, double period);

/// Whether the car coasts at `time` [s]: its braking has begun, with a deceleration of 0.
bool Coasts(const SpeedControlOptions& options, double time);

/// Commanded acceleration [m/s^2] of a car with `speed` whose wanted speed changes from wanted(x)
/// to wanted(x + ahead) within `period`. The command is the change of speed divided by the period,
/// plus gain [1/s] times the speed error. A car without error that follows commands exactly reaches
/// wanted(x + ahead).
double SpeedAlong(const Signal& wanted, double x, double ahead, double gain, double speed,
                  double period);

}  // namespace trackbed
