#pragma once

#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// Speed and acceleration limits.
struct SpeedLimits {
  double speed = 0.0;         ///< Speed [m/s], > 0.
  double acceleration = 0.0;  ///< Acceleration [m/s^2], > 0.
  double deceleration = 0.0;  ///< Deceleration [m/s^2], > 0.
};

/// Speed as a function of station. Between knots, v^2 is linear, so the acceleration is piecewise
/// constant. Speeds are >= 0; the path determines the direction of motion.
class SpeedProfile {
 public:
  struct Knot {
    double s = 0.0;      ///< Station [m].
    double speed = 0.0;  ///< Speed [m/s].
  };

  SpeedProfile() = default;
  /// InternalError unless stations are finite and strictly increasing, and speeds finite and >= 0.
  explicit SpeedProfile(std::vector<Knot> knots);

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }

  // The functions below return NaN if the station or time is NaN.

  /// The speed [m/s] at a station; constant before the first knot and after the last one.
  [[nodiscard]] double SpeedAt(double s) const;
  /// The acceleration dv/dt [m/s^2] of a car that follows the profile, in the interval after s. The
  /// acceleration is 0 outside the range of the knots.
  [[nodiscard]] double AccelerationAt(double s) const;
  /// The time [s] from the first knot to s for a car that follows the profile; infinite past a
  /// standstill.
  [[nodiscard]] double TimeAt(double s) const;
  /// The station [m] of a car that has followed the profile for `time` [s] from its first knot: the
  /// inverse of TimeAt. The station stays constant after the profile has come to rest.
  [[nodiscard]] double StationAt(double time) const;

 private:
  [[nodiscard]] std::size_t IntervalAt(double s) const;

  std::vector<Knot> knots_;
};

/// A section of a path with a speed limit.
struct SpeedCap {
  double from = 0.0;   ///< Start station [m].
  double to = 0.0;     ///< End station [m].
  double speed = 0.0;  ///< Speed limit [m/s], > 0.
};

/// Makes a profile that leaves s = 0 at `start_speed`, drives as fast as limits and caps allow, and
/// stops at s = length. If the length is too short to reach the speed limit, the profile peaks
/// below the limit. If the length is too short to brake from the start speed at the limit's
/// deceleration, the profile brakes harder, at a constant deceleration. If the start speed is above
/// the limit or a cap, the profile slows down at the limit's deceleration. PreconditionError for
/// numbers that are not finite; the numbers of a cap may be infinite.
SpeedProfile StopAtEnd(double length, double start_speed, const SpeedLimits& limits,
                       const std::vector<SpeedCap>& caps = {});

/// As StopAtEnd, for a path that may have cusps. The profile also stops at each cusp and at `stops`
/// [m].
SpeedProfile StopAtCusps(const Path& path, double start_speed, const SpeedLimits& limits,
                         const std::vector<SpeedCap>& caps = {},
                         const std::vector<double>& stops = {});

/// The reference of a controller: a path and a speed profile.
struct Reference {
  Path path;
  SpeedProfile speed;
};

/// Returns the part of a profile between two stations, shifted so that the first station becomes 0.
/// Knots in between keep their speeds.
SpeedProfile Excerpt(const SpeedProfile& profile, Stations within);

/// Returns a section of a path and its speeds; stations count from the start of the section.
Reference Excerpt(const Reference& reference, Stations within);

}  // namespace trackbed
