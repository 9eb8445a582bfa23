#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/state.h"

namespace trackbed {

/// How a run ended.
enum class DriveStatus {
  /// At rest at the goal, within drive.goal_tolerance. Without a path: the mission's duration is
  /// over.
  kArrived,
  kStopped,    ///< At rest elsewhere than at the goal.
  kBlocked,    ///< At rest before an obstacle, with no path around it.
  kPartial,    ///< At rest at the end of a partial plan (Plan::partial).
  kTimeLimit,  ///< The limit drive.time_limit has been reached.
  kDiverged,   ///< The simulation diverged (MuJoCo warning); the log ends before that.
  kSunk,       ///< A wheel is below the road by more than its radius.
  kAirborne,   ///< All wheels are above the road by more than their radius, for a second.
  /// The car should drive, but moved less than a centimeter in ten seconds.
  kStuck,
  kCollided,     ///< The car touched an obstacle; the log continues for one second.
  kRolledOver,   ///< The car leans by more than 60 degrees.
  kInterrupted,  ///< The caller stopped the run.
};

/// The spelling of a status in metrics.json: "arrived", "stopped", ….
const char* ToString(DriveStatus status);

/// One control period: the state and the command at its start. Clearance and `state.obstacle_force`
/// are the extremes over all physics steps of the preceding period.
struct LogRow {
  VehicleState state;
  Command command;
  /// Cross-track and heading error relative to the path, without its straight extensions unless the
  /// car stops slightly beyond the end. Nullopt without a path.
  std::optional<Projection> tracking;
  /// Smallest clearance of the footprint [m], 0 on contact; nullopt without obstacles.
  std::optional<double> clearance;
  /// Highest planned speed between the car and a point behind it, by the goal tolerance and one
  /// control period [m/s]. Nullopt without a path, at the end of the run, and while the controller
  /// or control.speed sets the speed.
  std::optional<double> planned_speed{};
  /// Pose that the controller received; none without measurement noise.
  std::optional<Pose2> measured;
  /// Diagnostics of the last update; columns as RunLog::controller_columns.
  std::vector<double> controller;
  bool valid = true;  ///< Whether the row is valid; false in a gap of a recorded drive.
};

/// A plan adopted during the run.
struct PlanChange {
  double time = 0.0;     ///< Time at which the plan took effect [s].
  double station = 0.0;  ///< Station in the log at which the plan's stations begin [m].
  Plan plan;
};

/// The log of one plant. The last row is the final state, with the command that led to it.
struct RunLog {
  std::string plant;
  DriveStatus status = DriveStatus::kArrived;
  std::string cause;  ///< Cause if the physics ended the run; else empty.
  /// Time of the first contact with an obstacle [s]; none: never.
  std::optional<double> contact_time;
  std::vector<std::string> controller_columns;  ///< Names from SteeringController::Columns.
  std::vector<LogRow> rows;  ///< Rows of the log; stations continue across plan changes.
  std::vector<PlanChange> changes;
  /// The time `t_s` and the car's configuration (CarModel::configuration_columns).
  Table configurations;
};

/// Converts the rows to the format of `<plant>.csv`. Columns that need a path or tyres are only
/// present if the run has a path or tyres.
Table ToTable(const RunLog& log);

}  // namespace trackbed
