#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/analysis/maneuver_metrics.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/analysis/record_metrics.h"
#include "trackbed/analysis/recovery.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Path tracking errors of a run, up to the first contact with an obstacle. Errors are sampled once
/// per control period.
struct TrackingMetrics {
  /// Default bound on the cross-track error [m], equal to the car's width; 0 (no bound) if the
  /// width is unknown.
  double corridor = 0.0;
  double cross_track_rms = 0.0;    ///< Root mean square of the cross-track error [m].
  double cross_track_max = 0.0;    ///< Largest magnitude of the cross-track error [m].
  double cross_track_max_s = 0.0;  ///< Station at which the cross-track error is largest [m].
  double cross_track_max_t = 0.0;  ///< Time at which the cross-track error is largest [s].
  double cross_track_final = 0.0;  ///< Signed cross-track error at the end of the run [m].
  double heading_error_rms = 0.0;  ///< Root mean square of the heading error [rad].
  double heading_error_max = 0.0;  ///< Largest magnitude of the heading error [rad].
  double heading_error_max_s = 0.0;
  double heading_error_max_t = 0.0;
  /// Distance of the rear axle from the mission's goal at the end of the run [m].
  double goal_distance = 0.0;
  /// Difference between the car's final heading and the goal's heading [rad].
  double goal_heading_error = 0.0;
  /// Largest amount by which the car's speed exceeds the planned speed (LogRow::planned_speed), >=
  /// 0 [m/s]; nullopt if the plan never sets the speed.
  std::optional<double> overspeed_max;
  double overspeed_max_s = 0.0;  ///< Station at which the car exceeds the planned speed most [m].
  double overspeed_max_t = 0.0;  ///< Time at which the car exceeds the planned speed most [s].
  /// Default bound on `overspeed_max` [m/s]: the largest excess of speed that the speed control can
  /// still correct (docs/verdict.md); nullopt: no default bound.
  std::optional<double> overspeed_limit;
};

/// The largest sustained oscillation of the steering command that neither the path nor the
/// measurement noise explains, such as a limit cycle (docs/verdict.md). Oscillations that are
/// smaller than the tolerance, or that decay, do not count.
struct OscillationMetrics {
  double amplitude = 0.0;           ///< Steering amplitude of the oscillation [rad], >= 0; 0: none.
  std::optional<double> frequency;  ///< Frequency of the oscillation [Hz], > 0; nullopt: none.
  double from_t = 0.0;              ///< Time at which the oscillation begins [s].
  double to_t = 0.0;                ///< Time up to which the oscillation lasts [s].
  double rate = 0.0;                ///< Largest steering rate of the oscillation [rad/s].
  /// Lateral motion of a kinematic car to each side that the oscillation causes [m].
  double sway = 0.0;
};

/// Clearance of the car from obstacles during a run.
struct ClearanceMetrics {
  double min = 0.0;        ///< Smallest distance between the car's footprint and an obstacle [m].
  double min_s = 0.0;      ///< Station at which an obstacle was nearest [m].
  double min_t = 0.0;      ///< Time at which an obstacle was nearest [s].
  bool collision = false;  ///< Whether the car touched an obstacle in any physics step.
  double force_max = 0.0;  ///< Largest contact force between the car and obstacles [N].
  double force_max_s = 0.0;
  double force_max_t = 0.0;
};

/// Distances of a plan and of a run from the mission's waypoints. The distance of a path from a
/// waypoint is the smallest distance between the rear axle and the waypoint. The distances omit the
/// first waypoint, which is the start of the route.
struct WaypointMissMetrics {
  double planned = 0.0;  ///< Largest distance of the initial plan from a waypoint [m].
  double max = 0.0;      ///< Largest distance of the driven path from a waypoint [m].
  int waypoint = 0;      ///< Index of the waypoint that has the distance `max`.
  double max_s = 0.0;    ///< Station at which the car is nearest to `waypoint` [m].
  double max_t = 0.0;    ///< Time at which the car is nearest to `waypoint` [s].
};

/// The path error that the limited steering rate causes in one turn: the measured error, and the
/// error predicted for open-loop steering.
struct TurnMetrics {
  int waypoint = 0;
  TurnError predicted;
  TurnError measured;
  double s = 0.0;  ///< Station of the middle of the turn, at which the error is measured [m].
  double t = 0.0;  ///< Time at which the path error of the turn is measured [s].
};

/// A lap on a closed track.
struct LapMetrics {
  double time_planned = 0.0;  ///< Lap time predicted by the plan's speed profile [s].
  double time = 0.0;          ///< Measured lap time, between two crossings of the start line [s].
  double s = 0.0;             ///< Station, on the planned path, at which the lap ends [m].
  double t = 0.0;             ///< Time at which the lap ends [s].
};

/// Result of a requirement of the scenario's section `expect`, evaluated over the whole log.
struct RequirementMetrics {
  std::string name;
  std::string formula;
  /// Robustness of the requirement, in the unit of the comparison that determines the robustness;
  /// nullopt if no log row determines the robustness, or if the formula could not be evaluated.
  std::optional<double> robustness;
  /// Whether the requirement is satisfied; false if the robustness is missing.
  bool satisfied = false;
  double s = 0.0;       ///< Station of the log row that determines the robustness [m].
  double t = 0.0;       ///< Time of the log row that determines the robustness [s].
  std::string problem;  ///< Reason why the robustness is missing; else empty.
};

struct PlantMetrics {
  std::string plant;
  DriveStatus status = DriveStatus::kArrived;
  double contact_s = 0.0;  ///< Station at which the car first touched an obstacle [m].
  double contact_t = 0.0;  ///< Time of the first contact, from the start of the run [s].
  /// Reason why the physics simulation ended the run, or by what a stopped car missed the goal
  /// (RunLog::cause); otherwise empty.
  std::string cause;
  double distance = 0.0;  ///< Driven distance [m].
  double time = 0.0;      ///< Simulated time [s].
  double end_s = 0.0;     ///< Station of the car at the end of the run [m].
  /// Largest lateral acceleration of the center of gravity [m/s^2], computed as the largest
  /// magnitude of the mean over any 0.1 s. The lateral acceleration after the first contact with an
  /// obstacle is ignored.
  double lateral_acceleration_max = 0.0;
  /// Station at which the lateral acceleration is largest (middle of the averaging window) [m].
  double lateral_acceleration_max_s = 0.0;
  /// Time at which the lateral acceleration is largest (middle of the averaging window) [s].
  double lateral_acceleration_max_t = 0.0;
  double steering_max = 0.0;  ///< Largest magnitude of the measured steering angle [rad].
  /// Largest rate of the measured steering angle [rad/s], averaged over 0.1 s, or over one control
  /// period if the period is longer.
  double steering_rate_max = 0.0;
  /// Station at which the steering rate is largest (end of the averaging window) [m].
  double steering_rate_max_s = 0.0;
  /// Time at which the steering rate is largest (end of the averaging window) [s].
  double steering_rate_max_t = 0.0;
  double steering_rate_limit = 0.0;  ///< The car's maximum steering rate [rad/s]; 0: unknown.
  double steering_limit = 0.0;       ///< The car's maximum steering angle [rad]; 0: unknown.
  /// Whether the wheels follow a prescribed steering angle, which is not checked against the car's
  /// steering limits.
  bool steering_is_prescribed = false;
  /// Root mean square of the steering rate [rad/s], each rate being the mean over one control
  /// period.
  double steering_rate_rms = 0.0;
  /// Fraction of the control periods in which the actuator turns at its maximum rate or is at its
  /// maximum angle, whatever the command is.
  double steering_saturated_fraction = 0.0;
  /// Rate of the reversals of the steering command by more than 1/180 of the largest steering angle
  /// (SAE J2944) [1/s].
  double steering_reversals = 0.0;
  /// `steering_rate_rms` divided by the car's maximum steering rate; nullopt if the maximum rate is
  /// unknown.
  std::optional<double> steering_activity;
  /// Sustained oscillation of the steering command; nullopt if the run has no path.
  std::optional<OscillationMetrics> oscillation;
  /// Ratio of the measured yaw rate to v tan(delta)/L, fitted by least squares over the run. The
  /// divisor v tan(delta)/L is the kinematic model's yaw rate at the measured speed and steering.
  /// In a steady turn, a car with understeer gradient K has the yaw rate ratio 1 / (1 + K v^2/L).
  /// The yaw rate ratio is nullopt if the root mean square of the yaw rate is at most 1 mrad/s.
  std::optional<double> yaw_rate_ratio;
  /// Path tracking errors; nullopt if the run has no path.
  std::optional<TrackingMetrics> tracking;
  /// Distances from the waypoints; nullopt if the mission has no waypoints.
  std::optional<WaypointMissMetrics> waypoint_miss;
  /// Clearance from obstacles; nullopt if the world has no obstacles.
  std::optional<ClearanceMetrics> clearance;
  /// Recovery after a disturbance; nullopt if no disturbance ends during the run.
  std::optional<RecoveryMetrics> recovery;
  int plan_changes = 0;  ///< Number of plans adopted during the run.
  /// Reason why the plan ended before the goal; empty if the plan reached the goal.
  std::string blocked;
  std::string partial;  ///< Reason why the plan is only partial; empty if the plan is complete.
  /// Metrics of the scenario's maneuver; nullopt if the scenario has no maneuver.
  std::optional<ManeuverMetrics> maneuver;
  /// Path errors in the isolated turns (IsolatedTurn) that the car drove.
  std::vector<TurnMetrics> turns;
  std::vector<LapMetrics> laps;  ///< Laps that the car completed on a closed track.
  /// Comparison of the run with the record; nullopt for the record itself.
  std::optional<RecordMetrics> recorded;
  /// Prediction errors of the plant for each horizon of `record.windows`; empty for the record
  /// itself.
  std::vector<WindowErrors> windows;
  /// Results of the requirements on all plants, followed by the requirements on the plant of this
  /// entry.
  std::vector<RequirementMetrics> requirements;
  /// Values of the metrics that MetricEntry::measure computes from the log, keyed by the metric's
  /// path.
  std::vector<std::pair<std::string, MetricReading>> measured;
};

/// Measures all metrics listed by Metrics() from the log of a run. Errors in turns are measured at
/// the stations that the controller used (`source`), interpolated between log rows.
PlantMetrics Measure(const RunLog& log, const Plan& plan, const VehicleParams& vehicle,
                     double control_period, StationSource source);

/// Returns the paths of all values that a plant's entry in metrics.json may have for the scenario,
/// in the order of the file. The path of a metric is a text such as "turns[0].lateral_offset".
std::vector<std::string> PossibleMetrics(const Scenario& scenario);

nlohmann::ordered_json ToJson(const PlantMetrics& metrics);

}  // namespace trackbed
