#include "trackbed/drive/run_log.h"

#include <algorithm>
#include <utility>

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

/// Appends the cells of the driver aids to a log row, in the order of LogColumns.
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

/// States which groups of columns the table of a run log contains.
struct Groups {
  bool tracked = false;
  bool obstacles = false;
  bool noise = false;
  bool wheels = false;
  bool trailer = false;
  bool gaps = false;
};

Groups GroupsOf(const RunLog& log) {
  if (log.rows.empty()) {
    return {};
  }
  const LogRow& first = log.rows.front();
  return {.tracked = first.tracking.has_value(),
          .obstacles = first.clearance.has_value(),
          .noise = first.measured.has_value(),
          .wheels = first.state.wheels.has_value(),
          .trailer = first.trailer.has_value(),
          .gaps = std::any_of(log.rows.begin(), log.rows.end(),
                              [](const LogRow& row) { return !row.valid; })};
}

Table EmptyTable(const RunLog& log, const Groups& groups) {
  const AidState aids = log.rows.empty() ? AidState{} : log.rows.front().aids.value_or(AidState{});
  return Table(LogColumns({.path = groups.tracked,
                           .obstacles = groups.obstacles,
                           .noise = groups.noise,
                           .wheels = groups.wheels,
                           .abs = aids.abs_active.has_value(),
                           .esc = aids.esc.has_value(),
                           .differential = aids.differential_torque.has_value(),
                           .trailer = groups.trailer,
                           .gaps = groups.gaps,
                           .origin = log.origin != Vec2::Zero(),
                           .controller = log.controller_columns}));
}

/// Returns the cells of a row of the log, in the order of the columns of EmptyTable.
std::vector<double> CellsOf(const RunLog& log, const Groups& groups, const LogRow& row) {
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
  if (groups.tracked) {
    cells.insert(cells.end(), {row.tracking->cross_track, row.tracking->heading_error});
  }
  if (groups.obstacles) {
    cells.insert(cells.end(), {*row.clearance, state.obstacle_force});
  }
  if (groups.noise) {
    cells.insert(cells.end(), {row.measured->x, row.measured->y, row.measured->yaw});
  }
  if (groups.wheels) {
    for (const WheelState& wheel : *state.wheels) {
      cells.insert(cells.end(), {wheel.normal_force, wheel.longitudinal_force, wheel.lateral_force,
                                 wheel.slip_angle, wheel.slip_ratio, wheel.friction_use});
    }
  }
  if (row.aids) {
    AddAids(*row.aids, cells);
  }
  if (groups.trailer) {
    cells.insert(cells.end(), {row.trailer->angle, row.trailer->rate});
  }
  if (groups.gaps) {
    cells.push_back(row.valid ? 1.0 : 0.0);
  }
  if (log.origin != Vec2::Zero()) {
    cells.insert(cells.end(), {log.origin.x(), log.origin.y()});
  }
  cells.insert(cells.end(), row.controller.begin(), row.controller.end());
  return cells;
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
  const Groups groups = GroupsOf(log);
  Table table = EmptyTable(log, groups);
  for (const LogRow& row : log.rows) {
    table.AddRow(CellsOf(log, groups, row));
  }
  return table;
}

std::function<std::string()> CsvParts(const RunLog& log) {
  constexpr std::size_t kRowsOfAPart = 1024;
  return [&log, groups = GroupsOf(log), next = std::size_t{0}, begun = false]() mutable {
    if (begun && next == log.rows.size()) {
      return std::string();
    }
    Table part = EmptyTable(log, groups);
    const std::size_t end = std::min(next + kRowsOfAPart, log.rows.size());
    for (; next < end; ++next) {
      part.AddRow(CellsOf(log, groups, log.rows[next]));
    }
    const std::string text = part.ToCsv();
    // Write the column names of the log only once, in the first part of the CSV text.
    return std::exchange(begun, true) ? text.substr(text.find('\n') + 1) : text;
  };
}

}  // namespace trackbed
