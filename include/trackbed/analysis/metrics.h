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

/// The effect of the limited steering rate in one turn, measured and predicted for open loop.
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
  double s = 0.0;             ///< station of the plan where it ended [m]
  double t = 0.0;             ///< when [s]
};

/// A requirement of `expect`, evaluated over the whole log.
struct RequirementMetrics {
  std::string name;
  std::string formula;
  /// In the unit of the comparison that decides; none if no sample decides, or the formula could
  /// not be evaluated.
  std::optional<double> robustness;
  bool satisfied = false;  ///< never without robustness
  double s = 0.0;          ///< where the sample that decides is [m]
  double t = 0.0;          ///< when [s]
  std::string problem;     ///< why there is no robustness
};

struct PlantMetrics {
  std::string plant;
  DriveStatus status = DriveStatus::kArrived;
  double contact_s = 0.0;  ///< where the car first touched an obstacle, if it collided [m]
  double contact_t = 0.0;  ///< when, from the start of the run [s]
  std::string cause;       ///< of a status that a fault of the physics has: RunLog::cause
  double distance = 0.0;   ///< driven [m]
  double time = 0.0;       ///< simulated [s]
  double end_s = 0.0;      ///< where it ended [m]
  /// Largest magnitude of the center of gravity's lateral acceleration, mean over any 0.1 s
  /// [m/s^2]: over the rows of the log within it, up to the first contact with an obstacle.
  double lateral_acceleration_max = 0.0;
  double lateral_acceleration_max_s = 0.0;  ///< where, the middle of that 0.1 s [m]
  double lateral_acceleration_max_t = 0.0;  ///< when, likewise [s]
  double steering_max = 0.0;                ///< largest magnitude of the measured angle [rad]
  /// Of the measured angle, mean over any 0.1 s, or one control period where that is longer
  /// [rad/s].
  double steering_rate_max = 0.0;
  double steering_rate_max_s = 0.0;     ///< where that 0.1 s ended [m]
  double steering_rate_max_t = 0.0;     ///< when [s]
  double steering_rate_limit = 0.0;     ///< of the car [rad/s]; 0: not known
  double steering_limit = 0.0;          ///< likewise, of the angle [rad]
  bool steering_is_prescribed = false;  ///< and so not held to these limits
  double steering_rate_rms = 0.0;       ///< of its means over the control periods [rad/s]
  /// Of the control periods: short of the command, with the actuator at its rate or angle limit.
  double steering_saturated_fraction = 0.0;
  /// Ratio of the yaw rate to v tan(delta)/L, the kinematic model's value for the measured speed
  /// and steering, by least squares over the run. 1 / (1 + K v^2/L) for a car of understeer
  /// gradient K that turns steadily. None for a car that never turned faster than 1 mrad/s (root
  /// mean square).
  std::optional<double> yaw_rate_ratio;
  std::optional<TrackingMetrics> tracking;    ///< none without a path
  std::optional<ClearanceMetrics> clearance;  ///< none without obstacles
  std::optional<RecoveryMetrics> recovery;    ///< none without a disturbance that ends
  int plan_changes = 0;                       ///< plans adopted during the run
  std::string blocked;                        ///< why the plan ended before the goal; else empty
  std::string partial;                        ///< why the plan is partial; else empty
  std::optional<ManeuverMetrics> maneuver;    ///< none if the scenario has no maneuver
  std::vector<TurnMetrics> turns;             ///< of the isolated turns that were driven
  std::vector<LapMetrics> laps;               ///< that were completed on a track
  std::optional<RecordMetrics> recorded;      ///< none without a record, and of the record itself
  std::vector<WindowErrors> windows;          ///< of each horizon of record.windows, likewise
  std::vector<RequirementMetrics> requirements;  ///< those on all plants, then its own
  /// Of the metrics that are measured on the log (MetricEntry::measure), by path.
  std::vector<std::pair<std::string, MetricReading>> measured;
};

/// Measures a run, by every metric of Metrics(). Turns are measured at the stations that the
/// controller went by (`source`), between rows.
PlantMetrics Measure(const RunLog& log, const Plan& plan, const VehicleParams& vehicle,
                     double control_period, StationSource source);

/// The paths of everything that a plant's entry in metrics.json can have in a run of the scenario:
/// "cross_track.max", "turns[0].lateral_offset", in the order of the file.
std::vector<std::string> PossibleMetrics(const Scenario& scenario);

nlohmann::ordered_json ToJson(const PlantMetrics& metrics);

}  // namespace trackbed
