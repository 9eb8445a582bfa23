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
  /// World, vehicle and hooks of `config` must outlive the Recorder, which keeps references to
  /// them. If `keeps_rows` is false, the log contains only the last row.
  Recorder(const LoopConfig& config, std::vector<std::string> controller_columns,
           bool keeps_rows = true);

  /// Records the plant's state at `time` [s]. Call Sample at the start of the run and after every
  /// physics step.
  void Sample(const Plant& plant, double time);

  /// Makes a row of the log from `state`, the last command, the controller's diagnostic values for
  /// this command, and the extremes of clearance and contact force since the last row.
  LogRow BeginRow(const VehicleState& state, const Command& command,
                  std::vector<double> controller_values);
  /// Adds a row to the log and calls the hook DriveHooks::logged if the hook is set.
  void AddRow(const LogRow& row);
  void AddPlanChange(PlanChange change) { log_.changes.push_back(std::move(change)); }

  /// Returns the time of the first contact with an obstacle [s], or nullopt if the car touched no
  /// obstacle.
  [[nodiscard]] const std::optional<double>& contact_time() const {
    return collisions_.contact_time();
  }

  /// Records the plant's configuration at the end of the run, at `time` [s]. Call SampleEnd before
  /// Finish.
  void SampleEnd(const Plant& plant, double time) { configurations_.RecordEnd(plant, time); }
  /// Completes the log and moves it out of this recorder.
  RunLog Finish(DriveStatus status, std::string cause = "");
  /// Returns a copy of the log so far, completed with `status`, `cause` and the plant's
  /// configuration at `time` [s].
  [[nodiscard]] RunLog Copy(DriveStatus status, std::string cause, const Plant& plant,
                            double time) const;

 private:
  RunLog log_;
  bool keeps_rows_;
  const DriveHooks& hooks_;
  ConfigurationLog configurations_;
  CollisionWatch collisions_;
};

}  // namespace trackbed
