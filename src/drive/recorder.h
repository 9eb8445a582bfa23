#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/drive/collision_watch.h"
#include "src/drive/configuration_log.h"
#include "trackbed/drive/closed_loop.h"

namespace trackbed {

/// Records the log of one run: rows, plan changes, configurations and the first contact.
class Recorder {
 public:
  /// The recorder keeps references to world, vehicle and hooks of the configuration, which must
  /// outlive it.
  Recorder(const LoopConfig& config, std::vector<std::string> controller_columns);

  /// Sample() must be called at the start and after every physics step, with the plant's state at
  /// `time` [s].
  void Sample(const Plant& plant, double time);

  /// Begins a row with `state`, the extremes since the last row, the last command, and the
  /// controller's values for that command.
  LogRow BeginRow(const VehicleState& state, const Command& command,
                  std::vector<double> controller_values);
  /// Adds a row and, if set, calls the hook `logged` (DriveHooks).
  void AddRow(const LogRow& row);
  void AddPlanChange(PlanChange change) { log_.changes.push_back(std::move(change)); }

  /// Time of the first contact with an obstacle [s]; none if there is no contact.
  [[nodiscard]] const std::optional<double>& contact_time() const {
    return collisions_.contact_time();
  }

  /// Moves the log out of this recorder.
  RunLog Finish(DriveStatus status, std::string cause = "");

 private:
  RunLog log_;
  const DriveHooks& hooks_;
  ConfigurationLog configurations_;
  CollisionWatch collisions_;
};

}  // namespace trackbed
