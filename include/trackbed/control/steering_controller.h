#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "trackbed/control/controller_options.h"
#include "trackbed/control/speed_controller.h"
#include "trackbed/options/method_options.h"
#include "trackbed/options/method_rules.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/vehicle/steering_schedule.h"

/// Defines the interface of steering controllers.
namespace trackbed {

struct Recording;

/// The inputs of a steering controller in one control period.
struct ControlInput {
  const VehicleParams& vehicle;
  const Reference& reference;
  const SteeringSchedule& schedule;
  VehicleState state;
  double station = 0.0;  ///< Station of the car on the path [m], computed as StationSource selects.
  double period = 0.0;   ///< Length of the control period [s].
  /// Time since the present plan took effect, or since the wait at its start ended [s]; 0 during
  /// the wait.
  double plan_time = 0.0;
  /// Gain of the speed control [1/s], for controllers that also set the speed.
  double speed_gain = SpeedControlOptions{}.gain;
};

/// Interface of a steering controller. The function Steer returns the commanded steering angle of
/// the bicycle model [rad] at the end of the coming control period. The vehicle's actuator limits
/// the steering angle and its rate. A controller must not perform input or output, must not read a
/// clock, and may draw random numbers only from a fixed seed.
class SteeringController {
 public:
  virtual ~SteeringController() = default;
  virtual double Steer(const ControlInput& input) = 0;

  /// Returns the commanded acceleration [m/s^2] over the coming control period, or nullopt if the
  /// controller leaves the speed to SpeedControl. Only the car's own limits restrict the commanded
  /// acceleration.
  virtual std::optional<double> Accelerate(const ControlInput& input);

  /// Diagnostic values of the controller's last update, which are written to the log. Columns
  /// returns the names of the diagnostic columns, which never change, and Values returns one value
  /// per column. By default, a controller has no diagnostic columns.
  [[nodiscard]] virtual std::vector<std::string> Columns() const;
  [[nodiscard]] virtual std::vector<double> Values() const;

  /// Returns an independent copy of the controller in its present state: for the same inputs, both
  /// controllers then return the same outputs. Returns nullptr if the controller cannot be copied,
  /// which is the default.
  [[nodiscard]] virtual std::unique_ptr<SteeringController> Clone() const;
};

/// Selects how the station on the path that a controller receives is computed.
enum class StationSource {
  kProjection,  ///< The station is that of the path point nearest to the car (closed loop).
  kOdometer,    ///< The station is the distance that the car has driven (open loop).
};

/// A controller in the registry (controllers.h). All function pointers of a registry entry except
/// `make` may be null.
struct ControllerEntry {
  const char* name;
  const char* summary;  ///< One-line description of the controller for users.
  ControllerOptions defaults;
  StationSource station = StationSource::kProjection;
  bool needs_plan = true;
  std::unique_ptr<SteeringController> (*make)(const ControllerOptions& options);

  // Members that check a controller's options or derive data from these options. The template
  // OnOptions adapts a function that takes the controller's own options struct to the type of such
  // a member.

  /// Checks conditions that involve several options of the controller.
  std::vector<OptionProblem> (*check)(const ControllerOptions& options,
                                      const CouldReadKey& could_read) = nullptr;
  /// Returns the time at which a run without a plan ends [s]. If the pointer `duration` is null or
  /// the function returns nullopt, the controller does not end the run.
  std::optional<double> (*duration)(const ControllerOptions& options) = nullptr;

  // Members for controllers that replay recorded inputs.

  /// Returns the recording that the controller replays.
  const Recording& (*recording)(const ControllerOptions& options) = nullptr;
  /// Whether the controller replays the scenario's recorded drive instead of a file.
  bool (*replays_record)(const ControllerOptions& options) = nullptr;
  void (*set_recording)(ControllerOptions& options, const Recording& recording) = nullptr;

  // Members that handle the input files named in a controller's options.

  /// Reads the files that the options name, and stores the contents of the files in the options.
  void (*read_inputs)(ControllerOptions& options, InputReader& reader) = nullptr;
  /// Returns copies of the input files that the options name; the copies are written to the run
  /// folder.
  std::vector<InputFile> (*input_files)(const ControllerOptions& options) = nullptr;
  /// All file names that the function `input_files` may return.
  std::vector<std::string> input_names{};
  /// Changes the file names in the options to the names of the files that `input_files` returns. If
  /// the controller replays the scenario's recorded drive (`from_record`), clears the file names.
  void (*resolve)(ControllerOptions& options, bool from_record) = nullptr;
};

/// Adds SteeringController::Clone to a controller class with a copy constructor.
template <typename Controller>
class CopyableController final : public SteeringController {
 public:
  explicit CopyableController(Controller inner) : inner_(std::move(inner)) {}

  double Steer(const ControlInput& input) override { return inner_.Steer(input); }
  std::optional<double> Accelerate(const ControlInput& input) override {
    return inner_.Accelerate(input);
  }
  [[nodiscard]] std::vector<std::string> Columns() const override { return inner_.Columns(); }
  [[nodiscard]] std::vector<double> Values() const override { return inner_.Values(); }
  [[nodiscard]] std::unique_ptr<SteeringController> Clone() const override {
    return std::make_unique<CopyableController>(*this);
  }

 private:
  Controller inner_;
};

/// Implements ControllerEntry::make for a controller class whose constructor takes the controller's
/// options. If the controller class has a copy constructor, which must copy all of the controller's
/// state, the controller can be copied (SteeringController::Clone).
template <typename Options, typename Controller>
std::unique_ptr<SteeringController> MakeBy(const ControllerOptions& options) {
  if constexpr (std::is_copy_constructible_v<Controller>) {
    return std::make_unique<CopyableController<Controller>>(Controller(options.Get<Options>()));
  } else {
    return std::make_unique<Controller>(options.Get<Options>());
  }
}

}  // namespace trackbed
