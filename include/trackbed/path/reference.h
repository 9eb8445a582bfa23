#pragma once

#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// Limits on the speed and acceleration of a car.
struct SpeedLimits {
  double speed = 0.0;         ///< Maximum speed of the car [m/s], > 0.
  double acceleration = 0.0;  ///< Maximum acceleration of the car [m/s^2], > 0.
  double deceleration = 0.0;  ///< Maximum deceleration of the car [m/s^2], > 0.
};

/// The speed of a car as a function of the station on the path. Between knots, v^2 is linear over
/// the station, so the acceleration is piecewise constant. Speeds are >= 0 even in reverse; the
/// path determines the direction of motion.
class SpeedProfile {
 public:
  struct Knot {
    double s = 0.0;      ///< Station [m].
    double speed = 0.0;  ///< Speed [m/s].
  };

  SpeedProfile() = default;
  /// Throws InternalError unless the stations are finite and strictly increasing, and the speeds
  /// are finite and >= 0.
  explicit SpeedProfile(std::vector<Knot> knots);

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }

  // The functions of SpeedProfile return NaN if the given station or time is NaN.

  /// Returns the speed at a station [m/s]; the speed is constant before the first knot and after
  /// the last knot.
  [[nodiscard]] double SpeedAt(double s) const;
  /// Returns the acceleration dv/dt at station s of a car that follows the profile [m/s^2]; at a
  /// knot, the acceleration directly after the knot. Returns an acceleration of 0 outside the range
  /// of the knots.
  [[nodiscard]] double AccelerationAt(double s) const;
  /// Returns the time that a car following the profile needs from the first knot to station s [s];
  /// infinite if the profile comes to a standstill before s.
  [[nodiscard]] double TimeAt(double s) const;
  /// Returns the station of a car that has followed the profile for `time` [s] from the first knot
  /// [m]; the inverse of TimeAt. The returned station stays constant after the car has come to
  /// rest.
  [[nodiscard]] double StationAt(double time) const;

 private:
  [[nodiscard]] std::size_t IntervalAt(double s) const;

  std::vector<Knot> knots_;
};

/// A section of a path with a speed limit.
struct SpeedCap {
  double from = 0.0;   ///< Start station of the section [m].
  double to = 0.0;     ///< End station of the section [m].
  double speed = 0.0;  ///< Speed limit of the section [m/s], > 0.
  /// Whether a car that starts too fast brakes as hard as necessary to keep the limit from the
  /// start of the section onwards. If `strict` is false, the car brakes at the maximum
  /// deceleration, and may be faster than the limit until its speed has fallen to the limit, as for
  /// SpeedLimits::speed.
  bool strict = true;
};

/// Makes a speed profile that starts at s = 0 with `start_speed`, is as fast as `limits` and `caps`
/// allow, and stops at s = `length`. If the length is too short to reach the speed limit, the
/// highest speed of the profile is below the limit. Where the limits would make the car overrun the
/// stop at the end or exceed a strict cap, the profile brakes harder than `limits` allow, at a
/// constant deceleration. The start speed may be above the speed limit, above a speed cap that is
/// not strict, or above a cap at the start. From a start speed above a limit, the profile slows
/// down at the maximum deceleration of `limits`. Throws PreconditionError if a number is not
/// finite; only the numbers of a cap may be infinite.
SpeedProfile StopAtEnd(double length, double start_speed, const SpeedLimits& limits,
                       const std::vector<SpeedCap>& caps = {});

/// Makes a speed profile in the same way as StopAtEnd, but for a path with cusps. In the profile,
/// the car also stops at each cusp and at the stations `stops` [m].
SpeedProfile StopAtCusps(const Path& path, double start_speed, const SpeedLimits& limits,
                         const std::vector<SpeedCap>& caps = {},
                         const std::vector<double>& stops = {});

/// The reference of a controller: a path and a speed profile.
struct Reference {
  Path path;
  SpeedProfile speed;
};

/// Returns the part of a speed profile between two stations, shifted so that the first station
/// becomes 0. Knots of the profile between the two stations keep their speeds.
SpeedProfile Excerpt(const SpeedProfile& profile, Stations within);

/// Returns a section of a path and the speeds on this section; stations count from the start of the
/// section.
Reference Excerpt(const Reference& reference, Stations within);

}  // namespace trackbed
