#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/sim/driver_aids.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/vehicle/trailer.h"

namespace trackbed {

/// The way in which a run ended.
enum class DriveStatus {
  /// The car is at rest at the goal, within drive.goal_tolerance. The duration of a mission without
  /// a path is over.
  kArrived,
  kStopped,  ///< The car is at rest, but not at the goal.
  /// The car is at rest in front of an obstacle, and the planner found no path around the obstacle.
  kBlocked,
  kPartial,    ///< The car is at rest at the end of a partial plan (Plan::partial).
  kTimeLimit,  ///< The run reached the limit drive.time_limit on the simulated time.
  kDiverged,   ///< The simulation diverged (MuJoCo warning); the log ends before the divergence.
  kSunk,       ///< A wheel sank below the road by more than the wheel's radius.
  kAirborne,   ///< For one second, all wheels were above the road by more than the wheels' radius.
  /// The car was commanded to drive, but moved less than a centimeter in ten seconds.
  kStuck,
  kCollided,  ///< The car touched an obstacle; the log continues for one second.
  /// The car or its trailer rolled over, which means a lean of more than 60 degrees.
  kRolledOver,
  kJackknifed,   ///< The hitch angle grew until the trailer touched the car (JackknifeAngle).
  kInterrupted,  ///< The calling program stopped the run.
};

/// Returns the name of a status as written in metrics.json, such as "arrived" or "stopped".
const char* ToString(DriveStatus status);

/// One row of the log: the state and the command at the start of a control period. `clearance` and
/// `state.obstacle_force` are the minimum and the maximum over all physics steps of the preceding
/// control period.
struct LogRow {
  VehicleState state;
  Command command;
  /// Cross-track and heading error of the car relative to the path; nullopt if there is no path. Up
  /// to the goal tolerance beyond the end of the path, the tracking errors are relative to the
  /// straight extension of the path. Beyond the end of the path by more than the goal tolerance,
  /// the tracking errors are relative to the end point.
  std::optional<Projection> tracking;
  /// Smallest distance from the footprints of car and trailer to the obstacles [m]; 0 on contact;
  /// nullopt if there are no obstacles.
  std::optional<double> clearance;
  /// Highest planned speed on a short stretch of the path directly behind the car [m/s]. The
  /// stretch for the planned speed is as long as the goal tolerance plus the distance driven in one
  /// control period. The planned speed is nullopt if there is no path, at the end of the run, and
  /// while the controller or control.speed sets the speed.
  std::optional<double> planned_speed{};
  /// Pose with measurement noise that the controller received; nullopt if there is no measurement
  /// noise.
  std::optional<Pose2> measured;
  /// Diagnostic values of the controller's last update, in the order of RunLog::controller_columns.
  std::vector<double> controller;
  /// States of the driver aids at the start of the control period; nullopt for a car without driver
  /// aids.
  std::optional<AidState> aids{};
  /// State of the trailer at the start of the control period; nullopt for a car without a trailer.
  std::optional<TrailerState> trailer{};
  bool valid = true;  ///< Whether the row is valid; false in a gap of a recorded drive.
};

/// A new plan that the car adopted during the run.
struct PlanChange {
  double time = 0.0;     ///< Time at which the plan took effect [s].
  double station = 0.0;  ///< Station in the log that corresponds to station 0 of the plan [m].
  Plan plan;
};

/// The log of a run of one plant. The last row contains the final state and the last command.
struct RunLog {
  std::string plant;
  DriveStatus status = DriveStatus::kArrived;
  /// Reason if the physics simulation ended the run, or if the car stopped beside the goal;
  /// otherwise empty.
  std::string cause;
  /// Time of the first contact with an obstacle [s]; nullopt if the car touched no obstacle.
  std::optional<double> contact_time;
  /// Origin of the log's coordinates, given in the coordinates of the scenario [m].
  Vec2 origin = Vec2::Zero();
  std::optional<TrailerParams> trailer{};  ///< The trailer of the car; nullopt: no trailer.
  /// Names of the diagnostic columns (SteeringController::Columns).
  std::vector<std::string> controller_columns;
  /// Rows of the log; the station keeps increasing when the plan changes.
  std::vector<LogRow> rows;
  std::vector<PlanChange> changes;
  /// Table of the car's configurations (CarModel::configuration_columns) at the times `t_s`.
  Table configurations;
};

/// Returns the footprint of the trailer's body at a row of the log; nullopt without a trailer.
std::optional<OrientedBox> TrailerFootprint(const RunLog& log, const LogRow& row);

/// Converts the rows of the log to the table that is stored as `<plant>.csv`. The table has columns
/// for a path or for tyres only if the run has a path or tyres, and columns `origin_x_m` and
/// `origin_y_m` only if the run has a local origin.
Table ToTable(const RunLog& log);

/// Returns a function that returns the next part of the text of `<plant>.csv` at each call. All
/// parts of the text together are equal to ToTable(log).ToCsv(). After the last part of the text,
/// each further call of the returned function returns an empty text. A part of the text has at most
/// 1024 rows, so that neither the table nor the text of a long log is in memory as a whole. The log
/// must outlive the returned function.
std::function<std::string()> CsvParts(const RunLog& log);

}  // namespace trackbed
