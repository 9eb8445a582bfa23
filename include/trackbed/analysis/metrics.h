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
  /// Default bound on the cross-track error: the car's width [m]. If the width is unknown, the
  /// value is 0, and there is no bound.
  double corridor = 0.0;
  double cross_track_rms = 0.0;    ///< Root mean square of the cross-track error [m].
  double cross_track_max = 0.0;    ///< Largest magnitude of the cross-track error [m].
  double cross_track_max_s = 0.0;  ///< Station of cross_track_max [m].
  double cross_track_max_t = 0.0;  ///< Time of cross_track_max [s].
  double cross_track_final = 0.0;  ///< Signed cross-track error at the end [m].
  double heading_error_rms = 0.0;  ///< Root mean square of the heading error [rad].
  double heading_error_max = 0.0;  ///< Largest magnitude of the heading error [rad].
  double heading_error_max_s = 0.0;
  double heading_error_max_t = 0.0;
  /// Distance of the rear axle from the mission's goal, at the end [m].
  double goal_distance = 0.0;
  double goal_heading_error = 0.0;  ///< Heading error at the end, relative to the goal [rad].
  /// Largest excess of the car's speed over LogRow::planned_speed, >= 0 [m/s]; nullopt if the plan
  /// never sets the speed.
  std::optional<double> overspeed_max;
  double overspeed_max_s = 0.0;  ///< Station of overspeed_max [m].
  double overspeed_max_t = 0.0;  ///< Time of overspeed_max [s].
  /// Default bound on overspeed_max [m/s]: the excess that the speed control can still correct
  /// (docs/verdict.md). If nullopt, there is no default bound.
  std::optional<double> overspeed_limit;
};

/// Clearance of a run from obstacles.
struct ClearanceMetrics {
  double min = 0.0;        ///< Smallest distance of the footprint from an obstacle [m].
  double min_s = 0.0;      ///< Station of the smallest distance [m].
  double min_t = 0.0;      ///< Time of the smallest distance [s].
  bool collision = false;  ///< Whether the car touched an obstacle, in any physics step.
  double force_max = 0.0;  ///< Largest contact force with obstacles [N].
  double force_max_s = 0.0;
  double force_max_t = 0.0;
};

/// The path error that the limited steering rate causes in one turn, as measured, and as predicted
/// for open-loop steering.
struct TurnMetrics {
  int waypoint = 0;
  TurnError predicted;
  TurnError measured;
  double s = 0.0;  ///< Station of the measurement, at the middle of the turn [m].
  double t = 0.0;  ///< Time of the measurement [s].
};

/// A lap on a closed track.
struct LapMetrics {
  double time_planned = 0.0;  ///< Lap time according to the plan's speed profile [s].
  double time = 0.0;          ///< Driven lap time, between crossings of the start line [s].
  double s = 0.0;             ///< Station of the plan at the lap's end [m].
  double t = 0.0;             ///< Time of the lap's end [s].
};

/// A requirement of `expect`, evaluated over the whole log.
struct RequirementMetrics {
  std::string name;
  std::string formula;
  /// Robustness in the unit of the decisive comparison. Nullopt if no sample of the log is
  /// decisive, or if the formula could not be evaluated.
  std::optional<double> robustness;
  bool satisfied = false;  ///< Whether the requirement is satisfied; false without robustness.
  double s = 0.0;          ///< Station of the decisive sample [m].
  double t = 0.0;          ///< Time of the decisive sample [s].
  std::string problem;     ///< Why the robustness is missing; else empty.
};

struct PlantMetrics {
  std::string plant;
  DriveStatus status = DriveStatus::kArrived;
  double contact_s = 0.0;  ///< Station at which the car first touched an obstacle [m].
  double contact_t = 0.0;  ///< Time of the first contact, from the start of the run [s].
  /// Cause of the end if the physics ended the run (RunLog::cause); else empty.
  std::string cause;
  double distance = 0.0;  ///< Driven distance [m].
  double time = 0.0;      ///< Simulated time [s].
  double end_s = 0.0;     ///< Station of the run's end [m].
  /// Largest lateral acceleration of the center of gravity [m/s^2]: magnitude of the mean over any
  /// 0.1 s. Log rows after the first contact with an obstacle are ignored.
  double lateral_acceleration_max = 0.0;
  double lateral_acceleration_max_s = 0.0;  ///< Station at the middle of the averaging window [m].
  double lateral_acceleration_max_t = 0.0;  ///< Time at the middle of the averaging window [s].
  double steering_max = 0.0;  ///< Largest magnitude of the measured steering angle [rad].
  /// Largest rate of the measured steering angle [rad/s]: mean over any 0.1 s, or over one control
  /// period if that is longer.
  double steering_rate_max = 0.0;
  double steering_rate_max_s = 0.0;  ///< Station at the end of the averaging window [m].
  double steering_rate_max_t = 0.0;  ///< Time at the end of the averaging window [s].
  double steering_rate_limit = 0.0;  ///< The car's limit of the steering rate [rad/s]; 0: unknown.
  double steering_limit = 0.0;       ///< The car's limit of the steering angle [rad]; 0: unknown.
  /// Whether steering is prescribed. A prescribed angle is not checked against the limits.
  bool steering_is_prescribed = false;
  /// Root mean square of the steering rate, averaged over each control period [rad/s].
  double steering_rate_rms = 0.0;
  /// Fraction of control periods in which the actuator, at its rate or angle limit, misses the
  /// command.
  double steering_saturated_fraction = 0.0;
  /// Measured yaw rate divided by v tan(delta)/L, by least squares over the run. The divisor v
  /// tan(delta)/L is the kinematic model's yaw rate at the measured speed and steering. In a steady
  /// turn, a car with understeer gradient K has the ratio 1 / (1 + K v^2/L). The ratio is nullopt
  /// if the car's root-mean-square yaw rate is at most 1 mrad/s.
  std::optional<double> yaw_rate_ratio;
  std::optional<TrackingMetrics> tracking;    ///< Path tracking; nullopt without a path.
  std::optional<ClearanceMetrics> clearance;  ///< Clearance; nullopt without obstacles.
  /// Recovery; nullopt if no disturbance of the run ends.
  std::optional<RecoveryMetrics> recovery;
  int plan_changes = 0;  ///< Number of plans adopted during the run.
  std::string blocked;   ///< Reason why the plan ended before the goal; else empty.
  std::string partial;   ///< Reason why the plan is partial; else empty.
  /// Maneuver metrics; none if the scenario has no maneuver.
  std::optional<ManeuverMetrics> maneuver;
  std::vector<TurnMetrics> turns;  ///< Isolated turns (IsolatedTurn) that the car drove.
  std::vector<LapMetrics> laps;    ///< Completed laps on a track.
  /// Comparison with the record; none for the record itself.
  std::optional<RecordMetrics> recorded;
  /// Prediction errors for each horizon of `record.windows`; empty for the record itself.
  std::vector<WindowErrors> windows;
  /// Requirements on all plants, followed by this plant's requirements.
  std::vector<RequirementMetrics> requirements;
  /// Values of the metrics that MetricEntry::measure computes from the log, by path.
  std::vector<std::pair<std::string, MetricReading>> measured;
};

/// Measures every metric of Metrics(). Turns are evaluated at the stations that the controller used
/// (`source`), interpolated between rows.
PlantMetrics Measure(const RunLog& log, const Plan& plan, const VehicleParams& vehicle,
                     double control_period, StationSource source);

/// The paths of all values that a plant's entry in metrics.json may have for the scenario, in file
/// order: "cross_track.max", "turns[0].lateral_offset".
std::vector<std::string> PossibleMetrics(const Scenario& scenario);

nlohmann::ordered_json ToJson(const PlantMetrics& metrics);

}  // namespace trackbed
