#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "trackbed/geometry/pose.h"

/// The response of a steering actuator to a commanded angle, without its rate and angle limits.
namespace trackbed {

/// A monotone curve through points: the piecewise cubic of Fritsch and Butland (1984), which does
/// not overshoot between two points. The curve is constant before the first point and after the
/// last point.
class MonotoneCurve {
 public:
  /// Makes a curve from at least four points (x, y). PreconditionError unless both coordinates are
  /// finite and strictly increasing.
  explicit MonotoneCurve(const std::vector<Vec2>& points);

  /// The value at x, exact at the points. PreconditionError for an x that is not finite. Cost O(log
  /// points).
  [[nodiscard]] double At(double x) const;

 private:
  double first_;  // x of the first point.
  double last_;   // x of the last point.
  std::function<double(double)> interpolant_;
};

/// The parameters of an actuator's response. For a commanded angle c(t), the actuator moves toward
/// u_4(t), within its limits:
///   u_1(t) = curve(c(t))                    the linkage and its calibration
///   u_2(t) = u_1(t - dead_time)             bus, computer and servo
///   time_constant u_3'(t) + u_3(t) = u_2(t) first order
///   u_4(t), with |u_4 - u_3| <= backlash/2  backlash: changes only at the edges of the play
/// All angles are bicycle angles at the road wheels [rad], positive to the left.
struct SteeringResponse {
  /// Points (command, angle) [rad] of a MonotoneCurve. Without points, the angle equals the
  /// command.
  std::vector<Vec2> curve{};
  double dead_time = 0.0;      ///< Dead time [s], >= 0.
  double time_constant = 0.0;  ///< Time constant [s], >= 0.
  double backlash = 0.0;       ///< Backlash, the total play [rad], >= 0.

  /// Whether commands pass unchanged and without delay.
  [[nodiscard]] bool ideal() const;
  /// Lag of the actuator behind a command that changes at a constant rate [s].
  [[nodiscard]] double delay() const { return dead_time + time_constant; }
};

/// Applies a steering response to commands. Guarantees: an ideal response returns the command, bit
/// for bit. A command that arrives during a timestep is weighted with the remaining fraction of the
/// timestep. The lag is exact for a command that is constant over each timestep. Cost O(log points
/// of the curve). PreconditionError for numbers that are not finite or out of range, or a dead time
/// of more than 10^7 timesteps.
class SteeringFilter {
 public:
  /// The actuator starts at `start` [rad], in the middle of the play. The initial state is that
  /// after a long constant command that holds the angle `start`. `timestep` [s] > 0 is the time
  /// between calls of Pass.
  SteeringFilter(const SteeringResponse& response, double timestep, double start);

  /// The angle [rad] toward which the actuator moves during the coming timestep, if `command` [rad]
  /// is commanded at the start of the timestep.
  double Pass(double command);

 private:
  std::optional<MonotoneCurve> curve_;
  double decay_;                    // Decay of the lag per timestep.
  double half_backlash_;            // Half the backlash [rad].
  std::vector<double> delay_line_;  // Ring buffer.
  std::size_t oldest_ = 0;
  // Fraction of a timestep in which the previous command still applies.
  double dead_time_fraction_ = 0.0;
  double arrived_;  // Command of the previous timestep.
  double lagged_;
  double output_;
};

}  // namespace trackbed
