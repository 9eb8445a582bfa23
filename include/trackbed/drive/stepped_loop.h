#pragma once

#include <memory>
#include <optional>
#include <string>

#include "trackbed/drive/closed_loop.h"

namespace trackbed {

/// A closed loop that the caller advances by one control period at a time, for example to learn a
/// controller, or to simulate several futures of a car.
///
///     SteppedLoop loop = MakeSteppedLoop(scenario, car, plan, "mujoco");
///     while (!loop.status()) {
///       loop.Step(MySteering(loop.input()), std::nullopt);
///     }
///
/// Guarantees: if every period is stepped by the loop's own controller, the log is the log of
/// SimulateClosedLoop, bit for bit; both use the same implementation. Several threads may step
/// different SteppedLoop objects at the same time. Cost: the same as SimulateClosedLoop.
class SteppedLoop {
 public:
  /// Begins the first control period. `controller` steers in Step(). The loop keeps `owner`, for
  /// example the car and the world to which the plant refers, until the loop is destroyed. If
  /// `keeps_log` is false, the log only contains its last row. `plant`, `controller`, `plan` and
  /// `config` must meet the requirements of SimulateClosedLoop, and the constructor throws the same
  /// errors as SimulateClosedLoop. Throws PreconditionError if `plant` or `controller` is nullptr.
  SteppedLoop(std::unique_ptr<Plant> plant, std::unique_ptr<SteeringController> controller,
              const FeasiblePlan& plan, LoopConfig config, std::shared_ptr<const void> owner = {},
              bool keeps_log = true);
  SteppedLoop(SteppedLoop&&) noexcept;
  SteppedLoop& operator=(SteppedLoop&&) noexcept;
  ~SteppedLoop();

  /// Returns an independent copy of the loop in its present state: for the same commands, both
  /// loops then simulate the same motion and write the same log, bit for bit. The original and the
  /// copy share the hooks (callbacks) of the configuration. Throws InputError if the plant or the
  /// controller cannot be copied (Plant::Clone, SteeringController::Clone); all built-in plants and
  /// controllers can be copied. Throws RunError if there is not enough memory.
  [[nodiscard]] SteppedLoop Copy() const;

  /// Returns how the run ended; nullopt if the run has not ended.
  [[nodiscard]] const std::optional<DriveStatus>& status() const;
  /// Returns the input that a controller receives in the coming control period. The returned input
  /// refers to this loop, and is valid until the next call of Step.
  [[nodiscard]] ControlInput input() const;
  /// Returns the row of the log at the beginning of the coming control period: state, tracking and
  /// clearance of the present moment, and the command of the previous period.
  [[nodiscard]] const LogRow& row() const;
  /// Returns the present plan, or its present segment between two stops.
  [[nodiscard]] const Plan& plan() const;
  /// Returns the length of a control period [s].
  [[nodiscard]] double period() const;

  /// Simulates the coming control period with the commands of the loop's own controller. Throws
  /// PreconditionError if the run has ended.
  void Step();
  /// Simulates the coming control period with the commanded steering angle of the bicycle model
  /// `steering` [rad], positive to the left. `acceleration` [m/s^2] is positive if the car speeds
  /// up in the direction of its gear; nullopt leaves the speed to the plan. `steering` and
  /// `acceleration` have the same meaning as the outputs of a SteeringController. A step with given
  /// commands does not call the loop's own controller. Throws PreconditionError, and leaves the
  /// loop unchanged, if a command is not finite or if the run has ended.
  void Step(double steering, std::optional<double> acceleration);

  /// Returns a copy of the log so far. If the run has not ended, the copy of the log has the status
  /// kInterrupted.
  [[nodiscard]] RunLog log() const;

 private:
  struct Parts;
  explicit SteppedLoop(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace trackbed
