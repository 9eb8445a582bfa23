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
  kArrived,      ///< at rest at the goal, within drive.goal_tolerance; without a path: the
                 ///< mission's duration is over
  kStopped,      ///< staying at rest elsewhere
  kBlocked,      ///< at rest before an obstacle without a path around it
  kPartial,      ///< at rest at the end of a partial plan (Plan::partial)
  kTimeLimit,    ///< drive.time_limit is over
  kDiverged,     ///< the simulation diverged (MuJoCo warning); the log ends before
  kSunk,         ///< a wheel is below the road by more than its radius
  kAirborne,     ///< all wheels are above the road by more than their radius, for a second
  kStuck,        ///< moved less than a centimeter in ten seconds although it should drive
  kCollided,     ///< the car touched an obstacle; the log continues for one second
  kRolledOver,   ///< the car leans by more than 60 degrees
  kInterrupted,  ///< the caller asked to stop
};

/// "arrived", "stopped", …: the spelling of metrics.json.
const char* ToString(DriveStatus status);

/// One control period: the state at its start and the command given then. Clearance and
/// `state.obstacle_force` are the extremes of the period that ended here, over every physics step.
struct LogRow {
  VehicleState state;
  Command command;
  /// Distance and heading error relative to the path without extensions (except for a car that
  /// stops slightly beyond the path's end); none without a path.
  std::optional<Projection> tracking;
  /// Smallest clearance of the footprint [m], 0 on contact; none without obstacles.
  std::optional<double> clearance;
  /// Highest speed of the plan over the goal tolerance and one control period behind the car [m/s].
  /// None without a path, at the end of the run, and where the controller or control.speed sets the
  /// speed instead of the plan.
  std::optional<double> planned_speed{};
  std::optional<Pose2> measured;  ///< the pose that the controller received; none without noise
  std::vector<double>
      controller;     ///< diagnostics of its last update; columns as RunLog::controller_columns
  bool valid = true;  ///< false in a gap of a recorded drive
};

/// A plan adopted during the run.
struct PlanChange {
  double time = 0.0;     ///< when it took effect [s]
  double station = 0.0;  ///< station in the log at which the plan's stations begin [m]
  Plan plan;
};

/// The log of one plant. The last row is the final state, with the command that led to it.
struct RunLog {
  std::string plant;
  DriveStatus status = DriveStatus::kArrived;
  std::string cause;                            ///< why the physics ended the run; else empty
  std::optional<double> contact_time;           ///< first contact with an obstacle [s]; none: never
  std::vector<std::string> controller_columns;  ///< SteeringController::Columns
  std::vector<LogRow> rows;                     ///< stations continue across plan changes
  std::vector<PlanChange> changes;
  Table configurations;  ///< `t_s` and the car's configuration (CarModel::configuration_columns)
};

/// The rows in the format of `<plant>.csv`. Columns that need a path or tyres are present only with
/// these.
Table ToTable(const RunLog& log);

}  // namespace trackbed
