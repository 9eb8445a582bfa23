#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/drive/fault_injector.h"
#include "src/drive/loop_surroundings.h"
#include "src/drive/recorder.h"
#include "src/drive/replanning_monitor.h"
#include "src/drive/segment_sequencer.h"
#include "src/drive/standstill.h"
#include "src/drive/termination.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/drive/closed_loop.h"

namespace trackbed {

/// Reports the progress of a run in steps of one percent.
class Progress {
 public:
  explicit Progress(const std::function<void(double)>& callback) : callback_(callback) {}

  void Report(double fraction) {
    const int hundredths = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * 100.0);
    if (callback_ && hundredths > last_) {
      last_ = hundredths;
      callback_(hundredths / 100.0);
    }
  }

 private:
  const std::function<void(double)>& callback_;
  int last_ = 0;
};

/// A closed loop that is advanced by one control period at a time; shared by SimulateClosedLoop and
/// SteppedLoop. The plant and the configuration must outlive the LoopCore, which refers to them.
class LoopCore {
 public:
  /// Begins the first control period. The argument `controller` only provides columns and values
  /// for the log. If `keeps_rows` is false, the log contains only the last row.
  LoopCore(Plant& plant, const SteeringController& controller, const FeasiblePlan& plan,
           const LoopConfig& config, bool keeps_rows = true);
  /// Copies a loop. The new loop steps `plant`, which must be in the same state as the plant of
  /// `other`.
  LoopCore(const LoopCore& other, Plant& plant) : LoopCore(other) {
    plant_ = &plant;
    surroundings_.BeginPeriod(state_, sequencer_.plan());
  }
  LoopCore& operator=(const LoopCore&) = delete;
  ~LoopCore() = default;

  /// Returns how the run ended, or nullopt if the run has not ended.
  [[nodiscard]] const std::optional<DriveStatus>& status() const { return status_; }
  /// Returns the log row of the start of the control period; the row contains the last command.
  [[nodiscard]] const LogRow& row() const { return row_; }
  [[nodiscard]] const Plan& plan() const { return sequencer_.plan(); }
  /// Returns the input of the controller for the control period. The returned input contains
  /// references to data of the LoopCore.
  [[nodiscard]] ControlInput Input() const;

  /// Simulates the control period with the commands of `controller`, then begins the next period.
  /// If `follow_schedule` is set, the car steers by the schedule LoopConfig::follow_schedule;
  /// otherwise, the controller steers. Do not call Step after the end of the run.
  void Step(SteeringController& controller, bool follow_schedule);

  /// Moves the log out of the LoopCore; the run must have ended.
  RunLog TakeLog() {
    recorder_.SampleEnd(*plant_, row_.state.time);
    return recorder_.Finish(*status_, termination_.cause());
  }
  /// Returns a copy of the log so far; the status is "interrupted" if the run has not ended.
  [[nodiscard]] RunLog CopyLog() const {
    return recorder_.Copy(status_.value_or(DriveStatus::kInterrupted), termination_.cause(),
                          *plant_, row_.state.time);
  }

 private:
  LoopCore(const LoopCore&) = default;

  /// Begins a control period: observes the plant, follows the plan, and ends the run if an end
  /// criterion is met.
  void BeginPeriod();
  /// Returns the plant's state at the beginning of the control period.
  [[nodiscard]] VehicleState Observe() const;

  /// Switches to a new plan or to the next segment of the plan if a switch is due. Returns the
  /// car's projection onto the plan, or nullopt without a path.
  std::optional<Projection> FollowPlan(const VehicleState& state, bool at_rest);

  /// Returns whether the car is at rest and will stay at rest. A car at standstill counts as at
  /// rest if it has no command to move. At the end of its segment, a car also counts as at rest if
  /// it cannot move despite a command, for example on a grade.
  bool Rests(const VehicleState& state);

  /// Returns the final status of the run if the run has ended.
  std::optional<DriveStatus> Ending(const VehicleState& state, bool at_rest);

  /// Returns whether the car coasts in this control period.
  [[nodiscard]] bool CarCoasts() const;

  /// Computes the command for the control period and stores the command in `row_`.
  void Control(SteeringController& controller, const ControlInput& input);
  double Steer(SteeringController& controller, const ControlInput& input);
  /// Returns the commanded acceleration along the car's x axis [m/s^2] over the control period.
  double Accelerate(SteeringController& controller, const ControlInput& input);
  /// Returns the wanted acceleration of the car, before disturbances. Options that prescribe the
  /// speed over time have priority over the controller, which has priority over the plan's speed
  /// profile.
  double WantedAcceleration(SteeringController& controller, const ControlInput& input);
  /// Returns the planned speed that is logged in LogRow::planned_speed.
  [[nodiscard]] std::optional<double> PlannedSpeed(const VehicleState& state) const;

  /// Returns the command in a physics step of the control period, without the steering schedule.
  [[nodiscard]] Command CommandAt(int step) const;
  /// Returns the command of the steering schedule in a physics step. The steering schedule is a
  /// function of the driven distance.
  [[nodiscard]] Command ScheduledCommand(int step, SteeringController& controller,
                                         const ControlInput& input);
  /// Steps the plant for the control period. `command` returns the command of each physics step.
  template <typename CommandOf>
  void StepPlant(const CommandOf& command);

  void ReportProgress(const VehicleState& state);

  Plant* plant_;
  const LoopConfig& config_;
  VehicleState start_;
  VehicleParams controlled_;  // Parameters of the nominal vehicle, which the controller assumes.
  int steps_;                 // Number of physics steps per control period.
  SegmentSequencer sequencer_;
  LoopSurroundings surroundings_;
  std::optional<ReplanningMonitor> monitor_;
  FaultInjector faults_;
  Recorder recorder_;
  Termination termination_;
  Standstill standstill_;
  Progress progress_;
  bool plan_sets_speed_ = false;
  bool throttle_released_ = false;  // Whether the car has reached LoopConfig::coasts_from.
  Command command_;                 // The last command to the plant.
  double steering_before_;          // Prescribed steering angle at the start of the period [rad].
  // Whether the loop adopted, in the present control period, a plan that does not stop at an
  // obstacle. The last command may still stop the car for the previous plan; the stop for the
  // previous plan must not end the run.
  bool continues_past_obstacle_ = false;
  std::vector<double> values_;  // Diagnostic values of the controller's last update.
  long tick_ = 0;               // Number of control periods before the present one.
  VehicleState state_;          // State of the plant at the beginning of the control period.
  LogRow row_;
  std::optional<DriveStatus> status_;
};

}  // namespace trackbed
