#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "trackbed/geometry/pose.h"

/// Computes the response of a steering actuator to a commanded angle, without the actuator's rate
/// and angle limits.
namespace trackbed {

/// A monotone curve through given points, computed as the piecewise cubic of Fritsch and Butland
/// (1984), which does not overshoot between two points. The monotone curve is constant before the
/// first point and after the last point.
class MonotoneCurve {
 public:
  /// Makes a curve from at least four points (x, y). Throws PreconditionError unless both
  /// coordinates of the points are finite and strictly increasing.
  explicit MonotoneCurve(const std::vector<Vec2>& points);

  /// Returns the value of the curve at x, which is exact at the given points. Throws
  /// PreconditionError if x is not finite. A call of At takes O(log n) for a curve through n
  /// points.
  [[nodiscard]] double At(double x) const;

 private:
  double first_;  // Coordinate x of the curve's first point.
  double last_;   // Coordinate x of the curve's last point.
  std::function<double(double)> interpolant_;
};

/// The parameters of an actuator's response. For a commanded angle c(t), the actuator moves toward
/// the angle u_4(t), within the actuator's limits:
///   u_1(t) = curve(c(t)), for the linkage and its calibration
///   u_2(t) = u_1(t - dead_time), for bus, computer and servo
///   time_constant u_3'(t) + u_3(t) = u_2(t), for the lag of first order
///   u_4(t) with |u_4 - u_3| <= backlash/2, for backlash; changes only at the edges of the play.
/// All angles are steering angles of the bicycle model [rad], positive to the left.
struct SteeringResponse {
  /// Points (command, angle) [rad] of the MonotoneCurve from the command to the steady angle. If
  /// `curve` has no points, the steady angle equals the command.
  std::vector<Vec2> curve{};
  double dead_time = 0.0;      ///< Dead time of the actuator [s], >= 0.
  double time_constant = 0.0;  ///< Time constant of the actuator's first-order lag [s], >= 0.
  double backlash = 0.0;       ///< Backlash of the steering, which is the total play [rad], >= 0.

  /// Whether the steering response passes commands unchanged and without delay.
  [[nodiscard]] bool ideal() const;
  /// Returns the delay [s] of the actuator behind a command that changes at a constant rate.
  [[nodiscard]] double delay() const { return dead_time + time_constant; }
};

/// Applies a steering response to commands. Guarantees: with an ideal response, the output of the
/// filter equals the command, bit for bit. If the delayed command changes during a timestep, the
/// old and the new command are weighted with their fractions of the timestep. The first-order lag
/// is computed exactly for a command that is constant over each timestep. A call of Pass takes
/// O(log n) for a curve with n points. Throws PreconditionError if a parameter of the steering
/// response is not finite or out of range, or if the dead time exceeds 10^7 timesteps.
class SteeringFilter {
 public:
  /// The actuator starts at the angle `start` [rad], in the middle of the play. SteeringFilter
  /// starts in the state after a long time of constant command that holds the angle `start`. The
  /// argument `timestep` [s], > 0, is the time between calls of Pass.
  SteeringFilter(const SteeringResponse& response, double timestep, double start);

  /// Returns the angle [rad] toward which the actuator moves during the coming timestep if
  /// `command` [rad] is commanded at the start of the timestep.
  double Pass(double command);

 private:
  std::optional<MonotoneCurve> curve_;
  double decay_;                    // Factor by which the first-order lag decays in a timestep.
  double half_backlash_;            // Half of the steering's backlash [rad].
  std::vector<double> delay_line_;  // Ring buffer.
  std::size_t oldest_ = 0;
  // Fraction of a timestep during which the previous delayed command still applies.
  double dead_time_fraction_ = 0.0;
  double arrived_;  // Delayed command of the previous timestep.
  double lagged_;
  double output_;
};

}  // namespace trackbed
