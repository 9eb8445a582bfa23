#include "src/drive/recorder.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace trackbed {
namespace {

/// Returns the largest possible number of rows of a run, but at most the number of rows that
/// scenarios allow.
std::size_t MostRows(const LoopConfig& config) {
  constexpr double kMostRows = 2e6;
  return static_cast<std::size_t>(
      std::clamp(config.time_limit / config.control_period + 2.0, 0.0, kMostRows));
}

}  // namespace

Recorder::Recorder(const LoopConfig& config, std::vector<std::string> controller_columns,
                   bool keeps_rows)
    : log_{.plant = {},
           .status = DriveStatus::kArrived,
           .contact_time = {},
           .trailer = config.trailer,
           .controller_columns = std::move(controller_columns),
           .rows = {},
           .changes = {},
           .configurations = Table({"t_s"})},
      keeps_rows_(keeps_rows),
      hooks_(config.hooks),
      configurations_(config.configuration_columns, config.world, config.state_period),
      collisions_(config.world, config.vehicle, config.trailer) {
  if (keeps_rows_) {
    // Reserve memory for all rows: a growing vector would copy all rows, and need twice the memory
    // during the copy. The reserved memory is used only when the rows are written.
    log_.rows.reserve(MostRows(config));
  }
}

void Recorder::Sample(const Plant& plant, double time) {
  configurations_.Record(plant, time);
  collisions_.Update(plant, time);
}

LogRow Recorder::BeginRow(const VehicleState& state, const Command& command,
                          std::vector<double> controller_values) {
  const CollisionWatch::Period seen = collisions_.Take();
  LogRow row{.state = state,
             .command = command,
             .tracking = {},
             .clearance = seen.clearance,
             .measured = {},
             .controller = std::move(controller_values)};
  row.state.obstacle_force = seen.force;
  return row;
}

void Recorder::AddRow(const LogRow& row) {
  if (!keeps_rows_) {
    log_.rows.clear();
  }
  log_.rows.push_back(row);
  if (hooks_.logged) {
    hooks_.logged(log_, configurations_.table());
  }
}

RunLog Recorder::Finish(DriveStatus status, std::string cause) {
  log_.status = status;
  log_.cause = std::move(cause);
  log_.contact_time = contact_time();
  log_.configurations = configurations_.Take();
  return std::move(log_);
}

RunLog Recorder::Copy(DriveStatus status, std::string cause, const Plant& plant,
                      double time) const {
  RunLog log = log_;
  log.status = status;
  log.cause = std::move(cause);
  log.contact_time = contact_time();
  ConfigurationLog configurations = configurations_;
  configurations.RecordEnd(plant, time);
  log.configurations = configurations.Take();
  return log;
}

}  // namespace trackbed
