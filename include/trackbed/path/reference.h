#pragma once

#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// How fast a car may go and how it gets there.
struct SpeedLimits {
  double speed = 0.0;         ///< [m/s], > 0
  double acceleration = 0.0;  ///< [m/s^2], > 0
  double deceleration = 0.0;  ///< [m/s^2], > 0
};

/// Speed over station: v^2 is linear between knots, that is, the acceleration is piecewise
/// constant. Speeds are >= 0; the sign of motion is the path's direction.
class SpeedProfile {
 public:
  struct Knot {
    double s = 0.0;      ///< [m]
    double speed = 0.0;  ///< [m/s]
  };

  SpeedProfile() = default;
  /// InternalError unless stations rise strictly and speeds are >= 0 and finite.
  explicit SpeedProfile(std::vector<Knot> knots);

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }

  /// [m/s]; before the first knot its speed, after the last one its speed.
  [[nodiscard]] double SpeedAt(double s) const;
  /// dv/dt [m/s^2] of a car that keeps the profile, on the side of larger s; 0 outside the knots.
  [[nodiscard]] double AccelerationAt(double s) const;
  /// Time [s] from the first knot to s when driven exactly; infinite where the profile stands
  /// still.
  [[nodiscard]] double TimeAt(double s) const;

 private:
  [[nodiscard]] std::size_t IntervalAt(double s) const;

  std::vector<Knot> knots_;
};

/// Leaves s = 0 at `start_speed`, goes at the limit, and stops at s = length. Where the length is
/// too short to reach the limit the profile peaks below it; where it is too short to stop from the
/// start speed at the limit's deceleration, it brakes harder, evenly.
SpeedProfile StopAtEnd(double length, double start_speed, const SpeedLimits& limits);

/// What a controller follows: where, and how fast.
struct Reference {
  Path path;
  SpeedProfile speed;
};

}  // namespace trackbed
