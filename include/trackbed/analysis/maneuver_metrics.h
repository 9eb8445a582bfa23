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

/// Metrics of standard maneuvers. The page docs/maneuvers.md describes all of them.
///
/// Symbols: delta steering of the road wheels [rad], psi' yaw rate [rad/s], a_y lateral
/// acceleration [m/s^2] and beta sideslip angle [rad] at the center of gravity, v speed [m/s], L
/// wheelbase [m]. The signs follow docs/conventions.md. Right turns are mirrored for metrics that
/// should not depend on the direction.
///
/// steady_state_circle and slowly_increasing_steer (ISO 4138, SAE J266), by least squares:
///   understeer_gradient  K, slope of delta - L psi'/v over a_y [rad s^2/m]
///   characteristic_speed sqrt(L/K) of K > 0, critical_speed sqrt(-L/K) of K < 0 [m/s]
///   yaw_rate_gain        of psi' = gain delta [1/s]
///   roll_gradient, sideslip_gradient  slopes of roll and beta over a_y [rad s^2/m]
///   lateral_acceleration_max          of the quasi-steady samples [m/s^2]
///   steering_at_0_3_g    of the ramp alone: from delta over a_y between 0.1 and 0.375 g [rad]
/// step_steer (ISO 7401), times from when delta is half-way:
///   yaw_rate_response_time, lateral_acceleration_response_time  to 90 % of the steady value [s]
///   yaw_rate_peak_time, lateral_acceleration_peak_time          to the largest value [s]
///   yaw_rate_overshoot, lateral_acceleration_overshoot  largest over steady value, minus 1
///   yaw_rate_steady [rad/s], lateral_acceleration_steady [m/s^2], sideslip_steady [rad]
///   yaw_rate_gain  steady psi' over delta [1/s]; tb  yaw_rate_peak_time times |sideslip| [s rad]
/// sine_with_dwell (ISO 19365, FMVSS 126): the steering begins at 5 degrees of the steering wheel
/// and is complete when it is back at zero; the peak yaw rate is that after its reversal.
///   yaw_rate_ratio_1_00, yaw_rate_ratio_1_75  psi' 1.00 s and 1.75 s after completion over the
///   peak; at most 0.35 and 0.20 to pass
///   lateral_displacement  of the center of gravity 1.07 s after the beginning [m]; at least 1.83
/// lane_change (ISO 3888): the four corners of the footprint between the edges of each gate.
///   margin  smallest distance of a corner inside an edge [m], negative outside; margin_gate the
///   section's number; margin_1, margin_3, margin_5; entry_speed, speed_loss [m/s]
/// braking (ISO 21994, ISO 7975), from the first period that commands more than 0.5 m/s^2, against
/// the circle (or straight line) that the rear axle was on then:
///   initial_speed [m/s]; distance to `to_speed` [m]; mean_fully_developed_deceleration
///   (v_b^2 - v_e^2)/(2 (s_e - s_b)) between 80 % and 10 % of the initial speed [m/s^2];
///   yaw_rate_max [rad/s], heading_deviation_max [rad], lateral_deviation_max [m]
/// disturbance, against the plan's path or else the circle or line that the rear axle was on at
/// `at`: lateral_deviation_max [m], heading_deviation_max [rad], yaw_rate_deviation_max [rad/s]
/// from the course's own; recovery_time [s] from the yaw rate first exceeding its bound to its last
/// return below it, 0 if never exceeded.
namespace trackbed {

struct ManeuverMetrics {
  std::string method;
  double begin = 0.0;  ///< Start of the evaluated part [s].
  double end = 0.0;    ///< End of the evaluated part [s].
  /// Computed as PlantMetrics::steering_saturated_fraction, over the control periods from `begin`
  /// to `end`.
  double steering_saturated_fraction = 0.0;
  std::vector<std::pair<std::string, double>> values;  ///< Metrics by name, in SI units.
  /// Whether the limits of the standard are met; nullopt if it has none. False if the car rolls
  /// over.
  std::optional<bool> passed;
  std::string missing;  ///< Unmeasured quantities and the reason; empty if all were measured.

  /// Returns a metric by its name.
  [[nodiscard]] std::optional<double> Find(std::string_view name) const;
};

/// Evaluates a run. `plan` holds the gates of a lane change. An incomplete maneuver (too short,
/// never steered) gives fewer metrics and a reason in `missing`. Never throws for a log with rows.
/// Cost: linear in the rows.
ManeuverMetrics EvaluateManeuver(const ManeuverOptions& options, const RunLog& log,
                                 const Plan& plan, const VehicleParams& vehicle);

/// Returns all metrics of an evaluation, each with the value 0.
ManeuverMetrics AllMetrics(const ManeuverOptions& options);

/// Lists every value in the section `maneuver` of metrics.json, by name, in file order.
std::vector<Metric> ListMetrics(const ManeuverMetrics& metrics);

/// Returns the label of a metric in the section `maneuver`; nullopt for an unknown name.
std::optional<MetricInfo> DescribeManeuverMetric(std::string_view name);

}  // namespace trackbed
