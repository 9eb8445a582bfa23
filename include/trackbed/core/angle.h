#pragma once

namespace trackbed {

inline constexpr double kPi = 3.14159265358979323846;

/// The angle in (-pi, pi] that points the same way as `angle` [rad]. NaN and infinities give NaN.
/// Exact for inputs already in range; otherwise within 1 ulp of |angle|.
double WrapAngle(double angle);

/// a - b [rad], wrapped to (-pi, pi].
double AngleDifference(double a, double b);

}  // namespace trackbed
