#pragma once

namespace trackbed {

inline constexpr double kPi = 3.14159265358979323846;

/// The angle in (-pi, pi] with the same direction as `angle` [rad]. NaN and infinities give NaN.
/// The result is exact for angles in (-pi, pi]; otherwise its error is at most 1 ulp of |angle|.
double WrapAngle(double angle);

/// The difference a - b [rad], wrapped to (-pi, pi].
double AngleDifference(double a, double b);

}  // namespace trackbed
