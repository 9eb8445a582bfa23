#pragma once

#include "trackbed/control/steering_controller.h"

/// How far ahead controllers look that aim at a point of the path, when they are not told.
///
/// Symbols: L wheelbase [m]; v speed [m/s]; omega steering rate at the road wheels [rad/s]; T
/// response time [s]; delta(s) = atan(L kappa(s)) steering of the path at station s [rad]; S the
/// ramp [m]: how far the car rolls while its wheels are behind the path's steering; R preview
/// distance [m].
///   R = max(3/4 L,  3 v T,  0.65 S + v T)
///   T = control period + steering lag + m v/(C_f + C_r)
///   S = max over s_1 < s_2 of  v abs(delta(s_2) - delta(s_1))/omega - (s_2 - s_1),
///       both stations no further than R from the car
///
/// 3/4 L: pure pursuit answers an offset e with 2 L e/R^2 and a heading error psi with 2 L psi/R;
/// a car on a circle of radius r cuts in by R^2/(8 r) on entering it, 3.5 % of L at 26 degrees.
///
/// 3 v T: behind a first-order lag T the characteristic polynomial of a kinematic car beside a
/// straight is T s^3 + s^2 + (2 v/R) s + 2 v^2/R^2, stable for R > v T (Routh), with a damping
/// ratio of 0.37 at 3 v T and of 1/2 at 4 v T. Heredia and Ollero 2007 for pure
/// delays; that the distance grows with the speed is common use (Snider 2009). m v/(C_f + C_r) is
/// the time constant with which tyres build up the lateral motion.
///
/// 0.65 S + v T: where the curvature steps, wheels at their limited rate need the distance S and
/// turn best half before and half behind the step. A point that comes upon it later than S/2
/// before cannot have them begin in time: they are late for good, and the car swings out. 0.65
/// leaves a margin for what is unknown about the car. The car passes a step of curvature kappa
/// within about kappa S^2/24, which is how far a ramp of length S deviates from the step. Where the
/// wheels can follow the path's curvature, S = 0.
namespace trackbed {

/// Slower cars are taken for as fast as this where something is divided by the speed [m/s].
inline constexpr double kCrawl = 0.5;

/// The offset from the path that default distances bring back a car from, over its wheelbase.
inline constexpr double kReturnOffset = 0.125;

/// T [s] of a car at `speed`, asked once per `period`. Without tyre coefficients none of theirs.
double ResponseTime(const VehicleParams& vehicle, double speed, double period);

/// R [m] of the car where it is now, with `delay` [s] more than its own response time. Samples the
/// path's steering at stations that are further apart the further they are from the car, which
/// finds S of a single step exactly. Looks no further than the path's ends and cusps.
double PreviewDistance(const ControlInput& input, double delay = 0.0);

/// The shortest preview [m] that the steering rate can act on, for a car at `speed` that is
/// `offset` [m] beside its path: on wheels that turn at their full rate the curvature changes by
/// c = omega/(L v) per meter, and swinging back over an offset e takes a distance in proportion to
/// cbrt(e/c). At no less than the speed 5/4 L omega.
double ReturnDistance(const VehicleParams& vehicle, double speed, double offset);

/// Of the car where it is now.
double ReturnDistance(const ControlInput& input);

}  // namespace trackbed
