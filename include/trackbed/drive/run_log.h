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
  kStopped,      ///< at rest elsewhere, and staying there
  kBlocked,      ///< at rest before an obstacle without a path around it
  kPartial,      ///< at rest at the end of a partial plan (Plan::partial)
  kTimeLimit,    ///< drive.time_limit is over
  kDiverged,     ///< the simulation diverged (MuJoCo warning); the log ends before
  kSunk,         ///< a wheel is below the road by more than its radius
  kAirborne,     ///< all wheels are above the road by more than their radius, for a second
  kStuck,        ///< for ten seconds it was to drive, and moved by less than a centimeter
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
  /// Distance and heading error against the path as it is, without extensions (but for a car that
  /// stops a little beyond its end); none without a path.
  std::optional<Projection> tracking;
  /// Smallest, of the footprint [m], 0 when it touched; none without obstacles.
  std::optional<double> clearance;
  std::optional<Pose2> measured;   ///< what the controller saw; none without noise
  std::vector<double> controller;  ///< diagnostics of its last update: RunLog's columns
  bool valid = true;               ///< false in a gap of a recorded drive
};

/// A plan adopted during the run.
struct PlanChange {
  double time = 0.0;     ///< when it took effect [s]
  double station = 0.0;  ///< in the log, where its own stations begin [m]
  Plan plan;
};

/// The log of one plant. The last row is the final state, with the command that led to it.
struct RunLog {
  std::string plant;
  DriveStatus status = DriveStatus::kArrived;
  std::string cause;  ///< of a run that a fault of the physics ended, for people; else empty
  std::optional<double> contact_time;           ///< first contact with an obstacle [s]; none: never
  std::vector<std::string> controller_columns;  ///< SteeringController::Columns
  std::vector<LogRow> rows;                     ///< stations continue across plan changes
  std::vector<PlanChange> changes;
  Table configurations;  ///< `t_s` and the car's configuration (CarModel::configuration_columns)
};

/// The rows as `<plant>.csv` has them: columns that need a path or tyres are present if these are.
Table ToTable(const RunLog& log);

}  // namespace trackbed
