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

/// Path tracking of a run, up to the first contact with an obstacle. Errors are taken at the
/// control periods.
struct TrackingMetrics {
  double corridor = 0.0;           ///< bound on the cross-track error unless a scenario sets
                                   ///< one: the car's width [m]; 0: unknown, no bound
  double cross_track_rms = 0.0;    ///< [m]
  double cross_track_max = 0.0;    ///< largest magnitude [m]
  double cross_track_max_s = 0.0;  ///< where [m]
  double cross_track_max_t = 0.0;  ///< when [s]
  double cross_track_final = 0.0;  ///< signed [m]
  double heading_error_rms = 0.0;  ///< [rad]
  double heading_error_max = 0.0;  ///< largest magnitude [rad]
  double heading_error_max_s = 0.0;
  double heading_error_max_t = 0.0;
  double goal_distance = 0.0;       ///< of the rear axle from the mission's goal, at the end [m]
  double goal_heading_error = 0.0;  ///< [rad]
  /// Largest amount by which the car is faster than LogRow::planned_speed, >= 0 [m/s]; none if the
  /// plan never sets the speed.
  std::optional<double> overspeed_max;
  double overspeed_max_s = 0.0;  ///< where [m]
  double overspeed_max_t = 0.0;  ///< when [s]
  /// Bound on it unless a scenario sets one: what the speed control can still correct
  /// (docs/verdict.md) [m/s]; none: no bound.
  std::optional<double> overspeed_limit;
};

/// Clearance of a run from obstacles.
struct ClearanceMetrics {
  double min = 0.0;        ///< of the footprint to the nearest obstacle [m]
  double min_s = 0.0;      ///< where [m]
  double min_t = 0.0;      ///< when [s]
  bool collision = false;  ///< the car touched an obstacle, in any physics step
  double force_max = 0.0;  ///< largest contact force with obstacles [N]
  double force_max_s = 0.0;
  double force_max_t = 0.0;
};

/// The effect of the limited steering rate in one turn, measured, and predicted for open loop.
struct TurnMetrics {
  int waypoint = 0;
  TurnError predicted;
  TurnError measured;
  double s = 0.0;  ///< where it was measured, the middle of the turn [m]
  double t = 0.0;  ///< when [s]
};

/// A lap on a closed track.
struct LapMetrics {
  double time_planned = 0.0;  ///< by the speed profile of the plan [s]
  double time = 0.0;          ///< between the crossings of the start line [s]
  double s = 0.0;             ///< station of the plan at the lap's end [m]
  double t = 0.0;             ///< time of the lap's end [s]
};

/// A requirement of `expect`, evaluated over the whole log.
struct RequirementMetrics {
  std::string name;
  std::string formula;
  /// In the unit of the decisive comparison; none if no sample decides, or the formula could not be
  /// evaluated.
  std::optional<double> robustness;
  bool satisfied = false;  ///< never without robustness
  double s = 0.0;          ///< station of the decisive sample [m]
  double t = 0.0;          ///< its time [s]
  std::string problem;     ///< why there is no robustness
};

struct PlantMetrics {
  std::string plant;
  DriveStatus status = DriveStatus::kArrived;
  double contact_s = 0.0;  ///< where the car first touched an obstacle, if it collided [m]
  double contact_t = 0.0;  ///< when, from the start of the run [s]
  std::string cause;       ///< why a status caused by the physics occurred: RunLog::cause
  double distance = 0.0;   ///< driven [m]
  double time = 0.0;       ///< simulated [s]
  double end_s = 0.0;      ///< station of the run's end [m]
  /// Largest magnitude of the center of gravity's lateral acceleration, as the mean over any 0.1 s
  /// [m/s^2]: over the log rows of that window, up to the first contact with an obstacle.
  double lateral_acceleration_max = 0.0;
  double lateral_acceleration_max_s = 0.0;  ///< middle of that window [m]
  double lateral_acceleration_max_t = 0.0;  ///< middle of that window [s]
  double steering_max = 0.0;                ///< largest magnitude of the measured angle [rad]
  /// Largest rate of the measured angle, as the mean over any 0.1 s, or over one control period if
  /// that is longer [rad/s].
  double steering_rate_max = 0.0;
  double steering_rate_max_s = 0.0;     ///< end of that window [m]
  double steering_rate_max_t = 0.0;     ///< end of that window [s]
  double steering_rate_limit = 0.0;     ///< of the car [rad/s]; 0: unknown
  double steering_limit = 0.0;          ///< of the car [rad]; 0: unknown
  bool steering_is_prescribed = false;  ///< a prescribed angle is not checked against these limits
  double steering_rate_rms = 0.0;       ///< of the mean rates of the control periods [rad/s]
  /// Fraction of control periods in which the actuator, at its rate or angle limit, misses the
  /// command.
  double steering_saturated_fraction = 0.0;
  /// Ratio of the yaw rate to v tan(delta)/L, the kinematic model's value for the measured speed
  /// and steering, by least squares over the run. 1 / (1 + K v^2/L) for a car of understeer
  /// gradient K that turns steadily. None for a car whose root-mean-square yaw rate is at most 1
  /// mrad/s.
  std::optional<double> yaw_rate_ratio;
  std::optional<TrackingMetrics> tracking;    ///< none without a path
  std::optional<ClearanceMetrics> clearance;  ///< none without obstacles
  std::optional<RecoveryMetrics> recovery;    ///< none without a disturbance that ends
  int plan_changes = 0;                       ///< plans adopted during the run
  std::string blocked;                        ///< why the plan ended before the goal; else empty
  std::string partial;                        ///< why the plan is partial; else empty
  std::optional<ManeuverMetrics> maneuver;    ///< none if the scenario has no maneuver
  std::vector<TurnMetrics> turns;             ///< of the isolated turns that the car drove
  std::vector<LapMetrics> laps;               ///< completed laps on a track
  std::optional<RecordMetrics> recorded;      ///< none without a record, and for the record itself
  std::vector<WindowErrors>
      windows;  ///< one per horizon of record.windows; empty for the record itself
  std::vector<RequirementMetrics> requirements;  ///< requirements on all plants, then this plant's
  /// Values of the metrics that are measured on the log (MetricEntry::measure), by path.
  std::vector<std::pair<std::string, MetricReading>> measured;
};

/// Measures every metric of Metrics(). Turns are measured, between rows, at the stations that the
/// controller used (`source`).
PlantMetrics Measure(const RunLog& log, const Plan& plan, const VehicleParams& vehicle,
                     double control_period, StationSource source);

/// The paths of all values that a plant's entry in metrics.json can have in a run of the scenario:
/// "cross_track.max", "turns[0].lateral_offset", in file order.
std::vector<std::string> PossibleMetrics(const Scenario& scenario);

nlohmann::ordered_json ToJson(const PlantMetrics& metrics);

}  // namespace trackbed
