#include "trackbed/drive/run_log.h"

#include <algorithm>

#include "trackbed/scenario/log_columns.h"

namespace trackbed {

const char* ToString(DriveStatus status) {
  switch (status) {
    case DriveStatus::kArrived:
      return "arrived";
    case DriveStatus::kStopped:
      return "stopped";
    case DriveStatus::kBlocked:
      return "blocked";
    case DriveStatus::kPartial:
      return "partial";
    case DriveStatus::kTimeLimit:
      return "time_limit";
    case DriveStatus::kDiverged:
      return "diverged";
    case DriveStatus::kSunk:
      return "sunk";
    case DriveStatus::kAirborne:
      return "airborne";
    case DriveStatus::kStuck:
      return "stuck";
    case DriveStatus::kRolledOver:
      return "rolled_over";
    case DriveStatus::kJackknifed:
      return "jackknifed";
    case DriveStatus::kCollided:
      return "collided";
    case DriveStatus::kInterrupted:
      return "interrupted";
  }
  return "";
}

namespace {

/// Appends the states of the driver aids, in the order of LogColumns.
void AddAids(const AidState& aids, std::vector<double>& cells) {
  if (aids.abs_active) {
    for (const bool active : *aids.abs_active) {
      cells.push_back(active ? 1.0 : 0.0);
    }
  }
  if (aids.esc) {
    cells.insert(cells.end(), aids.esc->brake_torque.begin(), aids.esc->brake_torque.end());
    cells.insert(cells.end(), {aids.esc->yaw_rate_reference, aids.esc->drive_share});
  }
  if (aids.differential_torque) {
    cells.push_back(*aids.differential_torque);
  }
}

}  // namespace

std::optional<OrientedBox> TrailerFootprint(const RunLog& log, const LogRow& row) {
  if (!log.trailer || !row.trailer) {
    return std::nullopt;
  }
  return TrailerFootprint(*log.trailer,
                          TrailerPose(*log.trailer, row.state.pose, row.trailer->angle));
}

Table ToTable(const RunLog& log) {
  const bool tracked = !log.rows.empty() && log.rows.front().tracking.has_value();
  const bool obstacles = !log.rows.empty() && log.rows.front().clearance.has_value();
  const bool wheels = !log.rows.empty() && log.rows.front().state.wheels.has_value();
  const AidState aids = log.rows.empty() ? AidState{} : log.rows.front().aids.value_or(AidState{});
  const bool trailer = !log.rows.empty() && log.rows.front().trailer.has_value();
  const bool noise = !log.rows.empty() && log.rows.front().measured.has_value();
  const bool gaps =
      std::any_of(log.rows.begin(), log.rows.end(), [](const LogRow& row) { return !row.valid; });
  Table table(LogColumns({.path = tracked,
                          .obstacles = obstacles,
                          .noise = noise,
                          .wheels = wheels,
                          .abs = aids.abs_active.has_value(),
                          .esc = aids.esc.has_value(),
                          .differential = aids.differential_torque.has_value(),
                          .trailer = trailer,
                          .gaps = gaps,
                          .origin = log.origin != Vec2::Zero(),
                          .controller = log.controller_columns}));
  for (const LogRow& row : log.rows) {
    const VehicleState& state = row.state;
    std::vector<double> cells{state.time,
                              state.pose.x,
                              state.pose.y,
                              state.pose.yaw,
                              state.speed,
                              state.lateral_speed,
                              state.yaw_rate,
                              state.roll,
                              state.pitch,
                              state.longitudinal_acceleration,
                              state.lateral_acceleration,
                              state.sideslip,
                              row.command.steering,
                              state.steering_actuator,
                              state.steering,
                              row.tracking ? row.tracking->s : state.distance};
    if (tracked) {
      cells.insert(cells.end(), {row.tracking->cross_track, row.tracking->heading_error});
    }
    if (obstacles) {
      cells.insert(cells.end(), {*row.clearance, state.obstacle_force});
    }
    if (noise) {
      cells.insert(cells.end(), {row.measured->x, row.measured->y, row.measured->yaw});
    }
    if (wheels) {
      for (const WheelState& wheel : *state.wheels) {
        cells.insert(cells.end(),
                     {wheel.normal_force, wheel.longitudinal_force, wheel.lateral_force,
                      wheel.slip_angle, wheel.slip_ratio, wheel.friction_use});
      }
    }
    if (row.aids) {
      AddAids(*row.aids, cells);
    }
    if (trailer) {
      cells.insert(cells.end(), {row.trailer->angle, row.trailer->rate});
    }
    if (gaps) {
      cells.push_back(row.valid ? 1.0 : 0.0);
    }
    if (log.origin != Vec2::Zero()) {
      cells.insert(cells.end(), {log.origin.x(), log.origin.y()});
    }
    cells.insert(cells.end(), row.controller.begin(), row.controller.end());
    table.AddRow(cells);
  }
  return table;
}

}  // namespace trackbed
