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
  /// The car is at rest at the goal, within drive.goal_tolerance. Without a path, the mission's
  /// duration is over.
  kArrived,
  kStopped,    ///< The car is at rest, but not at the goal.
  kBlocked,    ///< The car is at rest before an obstacle and found no path around the obstacle.
  kPartial,    ///< The car is at rest at the end of a partial plan (Plan::partial).
  kTimeLimit,  ///< The simulated time reached drive.time_limit.
  kDiverged,   ///< The simulation diverged (MuJoCo warning); the log ends before the divergence.
  kSunk,       ///< A wheel is below the road by more than its radius.
  kAirborne,   ///< All wheels are above the road by more than their radius, for a second.
  /// The car was commanded to drive, but moved less than a centimeter in ten seconds.
  kStuck,
  kCollided,     ///< The car touched an obstacle; the log continues for one second.
  kRolledOver,   ///< The car leans by more than 60 degrees.
  kInterrupted,  ///< The caller stopped the run.
};

/// Returns the name of a status in metrics.json: "arrived", "stopped", ….
const char* ToString(DriveStatus status);

/// One row of the log: the state and the command at the start of a control period. Clearance and
/// `state.obstacle_force` are the extremes over all physics steps of the preceding period.
struct LogRow {
  VehicleState state;
  Command command;
  /// Cross-track and heading error relative to the path. The straight extension of the path counts
  /// only for a car that stops slightly beyond the end. Nullopt without a path.
  std::optional<Projection> tracking;
  /// Smallest distance between the car's footprint and the obstacles [m], 0 on contact; nullopt
  /// without obstacles.
  std::optional<double> clearance;
  /// Highest planned speed between the car and a point behind the car [m/s]. The point is behind
  /// the car by the goal tolerance plus the distance driven in a control period. Nullopt without a
  /// path, at the end of the run, and while the controller or control.speed sets the speed.
  std::optional<double> planned_speed{};
  /// Noisy pose that the controller received; none without measurement noise.
  std::optional<Pose2> measured;
  /// Controller diagnostics of the last update, in the columns of RunLog::controller_columns.
  std::vector<double> controller;
  bool valid = true;  ///< False if the row lies in a gap of a recorded drive.
};

/// A plan adopted during the run.
struct PlanChange {
  double time = 0.0;     ///< Time at which the plan took effect [s].
  double station = 0.0;  ///< Station in the log at which the plan's stations begin [m].
  Plan plan;
};

/// The log of one run of one plant. The last row contains the final state and the last command.
struct RunLog {
  std::string plant;
  DriveStatus status = DriveStatus::kArrived;
  std::string cause;  ///< Cause of the end if the physics ended the run; otherwise empty.
  /// Time of the first contact with an obstacle [s]; none if the car touched no obstacle.
  std::optional<double> contact_time;
  std::vector<std::string> controller_columns;  ///< Names from SteeringController::Columns.
  std::vector<LogRow> rows;  ///< Rows of the log; stations continue across plan changes.
  std::vector<PlanChange> changes;
  /// Table of the car's configurations over the time `t_s` (CarModel::configuration_columns).
  Table configurations;
};

/// Converts the rows to the format of `<plant>.csv`. Columns that need a path or tyres are only
/// present if the run has a path or tyres.
Table ToTable(const RunLog& log);

}  // namespace trackbed
