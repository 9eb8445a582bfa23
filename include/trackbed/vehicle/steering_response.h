#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "trackbed/geometry/pose.h"

/// How a steering actuator follows a commanded angle, apart from its limits of rate and angle.
namespace trackbed {

/// A monotone curve through points: the piecewise cubic of Fritsch and Butland (1984), which does
/// not overshoot between two points; held before the first point and after the last.
class MonotoneCurve {
 public:
  /// At least four points (x, y), both strictly increasing and finite, else PreconditionError.
  explicit MonotoneCurve(const std::vector<Vec2>& points);

  /// Exact at the points. PreconditionError for an x that is not finite. Cost O(log points).
  [[nodiscard]] double At(double x) const;

 private:
  double first_;  // x of the first point
  double last_;   // x of the last point
  std::function<double(double)> interpolant_;
};

/// For a commanded angle c(t), the actuator moves toward u_4(t), within its limits:
///   u_1(t) = curve(c(t))                    the linkage and its calibration
///   u_2(t) = u_1(t - dead_time)             bus, computer and servo
///   time_constant u_3'(t) + u_3(t) = u_2(t) first order
///   u_4(t), with |u_4 - u_3| <= backlash/2  the play moves only at its edges
/// All angles are bicycle angles at the road wheels [rad], positive to the left.
struct SteeringResponse {
  std::vector<Vec2>
      curve{};             ///< (command, angle) [rad], of a MonotoneCurve; empty: angle = command
  double dead_time = 0.0;  ///< [s], >= 0
  double time_constant = 0.0;  ///< [s], >= 0
  double backlash = 0.0;       ///< total play [rad], >= 0

  /// Whether the actuator gets each command as it is, at once.
  [[nodiscard]] bool ideal() const;
  /// How far the actuator is behind a ramp of commands [s].
  [[nodiscard]] double delay() const { return dead_time + time_constant; }
};

/// Guarantees: an ideal response gives the command, bit for bit. A command that
/// arrives during a timestep counts for the share of it that is left. The lag is exact for a
/// command that is constant over each timestep. Cost O(log points of the curve). PreconditionError
/// for numbers that are not finite or out of range, or a dead time of more than 10^7 timesteps.
class SteeringFilter {
 public:
  /// The actuator stands at `start` [rad], in the middle of the play, as if what keeps it there had
  /// always been commanded. `timestep` [s] > 0 is the time from one Pass to the next.
  SteeringFilter(const SteeringResponse& response, double timestep, double start);

  /// The angle [rad] toward which the actuator moves during the coming timestep, when `command`
  /// [rad] is commanded at its start.
  double Pass(double command);

 private:
  std::optional<MonotoneCurve> curve_;
  double decay_;                    // of the lag, in a timestep
  double play_;                     // half the backlash [rad]
  std::vector<double> on_the_way_;  // a ring
  std::size_t oldest_ = 0;
  double late_share_ = 0.0;  // of a timestep in which what arrives is still the command before
  double arrived_;           // of the timestep before
  double lagged_;
  double given_;
};

}  // namespace trackbed
