#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/fmu/variables.h"
#include "trackbed/drive/drive.h"

namespace trackbed::fmu {

/// The commands of a control period.
struct Commands {
  double steering = 0.0;           ///< Steering angle [rad].
  double acceleration = 0.0;       ///< Acceleration [m/s^2].
  bool controller_steers = false;  ///< Whether the scenario's controller steers.
  bool plan_sets_speed = false;    ///< Whether the plan sets the speed.
};

enum class Phase : std::uint8_t { kInstantiated, kInitialization, kStepping, kTerminated };

/// The state of an FMU instance, that is, all its data that change during a simulation.
struct State {
  Phase phase = Phase::kInstantiated;
  double start_time = 0.0;                     ///< Start time of the simulation [s].
  std::map<std::uint32_t, double> parameters;  ///< Parameter values other than the start values.
  Commands commands;                           ///< Present values of the inputs.
  std::vector<Commands> history;               ///< Commands of all periods since the start.
  std::optional<SteppedLoop> loop;             ///< Control loop; empty before the initialization.

  [[nodiscard]] State Copy() const;
};

/// How a communication step ended.
struct StepEnd {
  bool ended = false;  ///< Whether the run has ended.
  double time = 0.0;   ///< Time at the end of the step [s].
};

/// An instance of an FMU, independent of the version of FMI. The functions of Unit throw InputError
/// for a value or a call that is not allowed. One thread may use an instance at a time; different
/// instances are independent.
class Unit {
 public:
  /// Reads the FMU's resources. Throws InputError if the resources do not belong to the FMU with
  /// the token `token`, and RunError if they cannot be read. The callback `warn` receives notes
  /// about the plan.
  Unit(std::filesystem::path resources, std::string token,
       std::function<void(const std::string&)> warn);

  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }

  /// Begins the initialization at time `start` [s].
  void EnterInitialization(double start);
  /// Plans the mission, makes the control loop, and ends the initialization.
  void ExitInitialization();
  void Terminate();
  /// Returns the FMU to its state after instantiation.
  void Reset();

  /// Advances the control loop by whole control periods, with the present inputs. `time` and `step`
  /// [s] are the communication point and the step size of the host.
  StepEnd Step(double time, double step);

  /// Returns the present time, and whether the run has ended.
  [[nodiscard]] StepEnd Present() const;

  void Set(Type type, std::uint32_t reference, double value);
  double Get(Type type, std::uint32_t reference);

  [[nodiscard]] State Save() const { return state_.Copy(); }
  void Restore(const State& state);
  /// Converts a state of the FMU to bytes, which contain the parameters and the commands of all
  /// control periods.
  [[nodiscard]] std::string Serialize(const State& state) const;
  /// Restores a serialized state by simulating the commands in `bytes` again. Throws InputError
  /// unless the repeated simulation ends in the serialized state.
  [[nodiscard]] State Deserialize(std::string_view bytes) const;

 private:
  [[nodiscard]] const Variable& Find(Type type, std::uint32_t reference) const;
  [[nodiscard]] SteppedLoop MakeLoop(const std::map<std::uint32_t, double>& parameters) const;
  void MakeLoopIfNeeded();
  [[nodiscard]] double Time() const;

  std::filesystem::path resources_;
  std::string token_;
  std::function<void(const std::string&)> warn_;
  std::vector<Variable> variables_;
  double period_ = 0.0;  ///< Control period [s].
  State state_;
  /// Cached values of the outputs by name; empty after each change of the state.
  std::map<std::string, double> outputs_;
};

/// Simulates a control period with `commands`.
void StepOnce(SteppedLoop& loop, const Commands& commands);

/// Returns a table with the row of the log at the present time. The command and the controller's
/// columns are those of the last control period.
Table PresentRow(const SteppedLoop& loop);

}  // namespace trackbed::fmu
