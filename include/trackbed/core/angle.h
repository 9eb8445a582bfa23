#pragma once

namespace trackbed {

inline constexpr double kPi = 3.14159265358979323846;

/// Wraps `angle` to (-pi, pi] [rad]. Returns NaN if `angle` is NaN or infinite. The wrapped angle
/// is exact for angles in (-pi, pi]; for other angles, its error is at most one unit in the last
/// place (ulp) of |angle|.
double WrapAngle(double angle);

/// Returns the difference a - b of two angles [rad], wrapped to (-pi, pi].
double AngleDifference(double a, double b);

}  // namespace trackbed
