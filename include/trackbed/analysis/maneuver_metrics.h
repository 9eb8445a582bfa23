#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "trackbed/analysis/metric_value.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/maneuver.h"
#include "trackbed/vehicle/params.h"

/// Metrics of standard maneuvers. The page docs/maneuvers.md describes all maneuver metrics.
///
/// Symbols: delta steering of the road wheels [rad], psi' yaw rate [rad/s], a_y lateral
/// acceleration [m/s^2] and beta sideslip angle [rad] at the center of gravity, v speed [m/s], L
/// wheelbase [m]. The signs of all quantities follow docs/conventions.md. Metrics that should not
/// depend on the direction of the turn are computed as if every turn went to the left.
///
/// Metrics of steady_state_circle and slowly_increasing_steer (ISO 4138, SAE J266), from
/// least-squares fits:
///   understeer_gradient: K, slope of delta - L psi'/v over a_y [rad s^2/m].
///   characteristic_speed: sqrt(L/K) if K > 0 [m/s].
///   critical_speed: sqrt(-L/K) if K < 0 [m/s].
///   yaw_rate_gain: psi' divided by delta [1/s].
///   roll_gradient, sideslip_gradient: slopes of roll and beta over a_y [rad s^2/m].
///   lateral_acceleration_max: largest a_y of the quasi-steady samples [m/s^2].
///   steering_at_0_3_g: delta at a_y = 0.3 g [rad], from a line fitted between 0.1 and 0.375 g;
///   only for slowly_increasing_steer.
///
/// Metrics of step_steer (ISO 7401), with times counted from the moment at which delta reaches half
/// of the step:
///   yaw_rate_response_time, lateral_acceleration_response_time: time until 90 % of the steady
///   value is reached [s].
///   yaw_rate_peak_time, lateral_acceleration_peak_time: time until the largest value is reached
///   [s].
///   yaw_rate_overshoot, lateral_acceleration_overshoot: largest value over steady value, minus 1.
///   yaw_rate_steady [rad/s], lateral_acceleration_steady [m/s^2], sideslip_steady [rad]: steady
///   values.
///   yaw_rate_gain: steady psi' divided by delta [1/s].
///   tb: TB factor, equal to yaw_rate_peak_time times |sideslip_steady| [s rad].
///
/// In a sine_with_dwell maneuver (ISO 19365, FMVSS 126), the steering begins when the steering
/// wheel reaches 5 degrees. In sine_with_dwell, the steering is complete when the steering wheel is
///   back at zero. The peak yaw rate of sine_with_dwell is the largest yaw rate after the steering
///   has reversed. Metrics of sine_with_dwell:
///   yaw_rate_ratio_1_00, yaw_rate_ratio_1_75: psi' 1.00 s and 1.75 s after the steering is
///   complete, divided by the peak yaw rate; at most 0.35 and 0.20 to pass.
///   lateral_displacement: displacement of the center of gravity 1.07 s after the steering begins
///   [m]; at least 1.83 to pass.
///
/// In a lane_change maneuver (ISO 3888), the four corners of the footprint must stay between the
/// edges of each gate. Metrics of lane_change:
///   margin: smallest distance of a corner from an edge [m], negative outside of the gate.
///   margin_gate: number of the section with the smallest margin.
///   margin_1, margin_3, margin_5: margins of sections 1, 3 and 5 [m].
///   entry_speed, speed_loss [m/s].
///
/// A braking maneuver (ISO 21994, ISO 7975) is evaluated from the first control period with a
/// commanded deceleration above 0.5 m/s^2. Deviations in a braking maneuver are measured from the
/// circle (or straight line) on which the rear axle moved in the first control period of braking.
/// Speeds and distances are those of the center of gravity in its direction of motion. The braking
/// distance of a car that spins does not end while the car slides sideways. Metrics of braking:
///   initial_speed [m/s]; distance to `to_speed` [m].
///   mean_fully_developed_deceleration: (v_b^2 - v_e^2)/(2 (s_e - s_b)) between 80 % and 10 % of
///   the initial speed [m/s^2].
///   yaw_rate_max [rad/s], heading_deviation_max [rad], lateral_deviation_max [m].
///
/// Deviations after a disturbance are measured from the plan's path. Without a path, deviations
/// after a disturbance are measured from the circle or line on which the rear axle moved at the
/// time `at`. Metrics of disturbance:
///   lateral_deviation_max [m], heading_deviation_max [rad], yaw_rate_deviation_max [rad/s].
///   recovery_time: time from the first moment at which the yaw rate deviation exceeds its bound to
///   the last moment at which the deviation returns below the bound [s]; 0 if the deviation never
///   exceeds the bound.
namespace trackbed {

struct ManeuverMetrics {
  std::string method;
  double begin = 0.0;  ///< Start of the evaluated part of the run [s].
  double end = 0.0;    ///< End of the evaluated part of the run [s].
  /// Fraction of the control periods from `begin` to `end` in which the steering is saturated,
  /// computed as PlantMetrics::steering_saturated_fraction.
  double steering_saturated_fraction = 0.0;
  /// Values of the maneuver metrics by name, in SI units.
  std::vector<std::pair<std::string, double>> values;
  /// Whether the run meets the limits of the standard; nullopt if the standard has no limits. If
  /// the car rolls over, the maneuver has not passed.
  std::optional<bool> passed;
  /// Lists the metrics that could not be measured, with the reasons; empty if all were measured.
  std::string missing;

  /// Returns the value of the maneuver metric `name`.
  [[nodiscard]] std::optional<double> Find(std::string_view name) const;
};

/// Evaluates the maneuver of a run. `plan` provides the gates of a lane change. For an incomplete
/// maneuver (too short, or without steering), some metrics are absent and `missing` states the
/// reason. EvaluateManeuver never throws for a log with at least one row. Cost: linear in the
/// number of log rows.
ManeuverMetrics EvaluateManeuver(const ManeuverOptions& options, const RunLog& log,
                                 const Plan& plan, const VehicleParams& vehicle);

/// Returns the names of all metrics that the maneuver can have, each with the placeholder value 0.
ManeuverMetrics AllMetrics(const ManeuverOptions& options);

/// Returns every value in the section `maneuver` of metrics.json with its name, in the order of the
/// file.
std::vector<Metric> ListMetrics(const ManeuverMetrics& metrics);

/// Returns the label of a maneuver metric by its name in the section `maneuver` of metrics.json;
/// nullopt for an unknown name.
std::optional<MetricInfo> DescribeManeuverMetric(std::string_view name);

}  // namespace trackbed
