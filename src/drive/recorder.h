#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/drive/collision_watch.h"
#include "src/drive/configuration_log.h"
#include "trackbed/drive/closed_loop.h"

namespace trackbed {

/// Makes the log of one run: its rows, plan changes, configurations and first contact.
class Recorder {
 public:
  /// Refers to world, vehicle and hooks of the configuration, which must outlive it.
  Recorder(const LoopConfig& config, std::vector<std::string> controller_columns);

  /// Looks at the plant as it is at `time` [s], at the start and after every physics step.
  void Sample(const Plant& plant, double time);

  /// Begins a row: `state` with the extremes since the row before, the command that led there, and
  /// what the controller told then.
  LogRow BeginRow(const VehicleState& state, const Command& command,
                  std::vector<double> controller_values);
  /// Adds a row, and calls `logged` (DriveHooks) if it is set.
  void AddRow(const LogRow& row);
  void AddPlanChange(PlanChange change) { log_.changes.push_back(std::move(change)); }

  /// When the car first touched an obstacle [s]; none: it has not.
  [[nodiscard]] const std::optional<double>& contact_time() const {
    return collisions_.contact_time();
  }

  /// The log, which this recorder then no longer has.
  RunLog Finish(DriveStatus status, std::string cause = "");

 private:
  RunLog log_;
  const DriveHooks& hooks_;
  ConfigurationLog configurations_;
  CollisionWatch collisions_;
};

}  // namespace trackbed
