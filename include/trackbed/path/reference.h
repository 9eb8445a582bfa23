#pragma once

#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// Speed and acceleration limits.
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
  /// InternalError unless stations are finite and rise strictly, speeds are >= 0 and finite.
  explicit SpeedProfile(std::vector<Knot> knots);

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }

  // Of a station or time that is NaN they are NaN.

  /// [m/s]; before the first knot its speed, after the last one its speed.
  [[nodiscard]] double SpeedAt(double s) const;
  /// dv/dt [m/s^2] of a car that keeps the profile, on the side of larger s; 0 outside the knots.
  [[nodiscard]] double AccelerationAt(double s) const;
  /// Time [s] from the first knot to s when driven exactly; infinite where the profile stands
  /// still.
  [[nodiscard]] double TimeAt(double s) const;
  /// The station [m] of a car that has followed the profile exactly for `time` [s] from its first
  /// knot: the inverse of TimeAt. Where the profile comes to rest, it stays.
  [[nodiscard]] double StationAt(double time) const;

 private:
  [[nodiscard]] std::size_t IntervalAt(double s) const;

  std::vector<Knot> knots_;
};

/// A section of a path with a speed limit.
struct SpeedCap {
  double from = 0.0;   ///< [m]
  double to = 0.0;     ///< [m]
  double speed = 0.0;  ///< [m/s], > 0
};

/// Leaves s = 0 at `start_speed`, drives as fast as limits and caps allow, and stops at s = length.
/// Where there is no length to reach the limit the profile peaks below it; where there is none to
/// brake from the start speed at the limit's deceleration, it brakes harder, evenly. A start above
/// the limit, or within a cap and above it, comes down at the limit's deceleration.
/// PreconditionError for numbers that are not finite; those of a cap may be infinite.
SpeedProfile StopAtEnd(double length, double start_speed, const SpeedLimits& limits,
                       const std::vector<SpeedCap>& caps = {});

/// The same for a path that may have cusps: stops at each of them, and at `stops` [m], too.
SpeedProfile StopAtCusps(const Path& path, double start_speed, const SpeedLimits& limits,
                         const std::vector<SpeedCap>& caps = {},
                         const std::vector<double>& stops = {});

/// The reference of a controller: path and speed.
struct Reference {
  Path path;
  SpeedProfile speed;
};

/// The speeds between two stations, which then count from the first of them; the knots in between
/// stay what they are.
SpeedProfile Excerpt(const SpeedProfile& profile, Stations within);

/// A section of a path and its speeds, likewise.
Reference Excerpt(const Reference& reference, Stations within);

}  // namespace trackbed
