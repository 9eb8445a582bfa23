#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/control/controller_options.h"
#include "trackbed/control/speed_controller.h"
#include "trackbed/options/method_options.h"
#include "trackbed/options/method_rules.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/vehicle/steering_schedule.h"

/// The interface of steering controllers.
namespace trackbed {

struct Recording;

/// The input of a controller in one control period.
struct ControlInput {
  const VehicleParams& vehicle;
  const Reference& reference;
  const SteeringSchedule& schedule;
  VehicleState state;
  double station = 0.0;    ///< Station of the car on the path [m]; see StationSource.
  double period = 0.0;     ///< Length of the control period [s].
  double plan_time = 0.0;  ///< Time since the plan took effect [s].
  /// Gain of the speed control [1/s], for controllers that also set the speed.
  double speed_gain = SpeedControlOptions{}.gain;
};

/// A steering controller. Steer returns the commanded bicycle angle [rad] at the end of the coming
/// period; the vehicle's actuator limits angle and rate. A controller does no input or output,
/// reads no clock, and draws random numbers only from a fixed seed.
class SteeringController {
 public:
  virtual ~SteeringController() = default;
  virtual double Steer(const ControlInput& input) = 0;

  /// The commanded acceleration [m/s^2] over the coming period; only the car limits it. Nullopt if
  /// SpeedControl sets the speed.
  virtual std::optional<double> Accelerate(const ControlInput& input);

  /// Diagnostics of the last update, for the log: constant column names, and one value per column.
  /// The list is empty by default.
  [[nodiscard]] virtual std::vector<std::string> Columns() const;
  [[nodiscard]] virtual std::vector<double> Values() const;
};

/// The source of a controller's station.
enum class StationSource {
  kProjection,  ///< Nearest point of the path: closed loop.
  kOdometer,    ///< Distance driven: open loop.
};

/// A controller in the registry (controllers.h). The functions may be null, except `make`.
struct ControllerEntry {
  const char* name;
  const char* summary;  ///< One-line summary for users.
  ControllerOptions defaults;
  StationSource station = StationSource::kProjection;
  bool needs_plan = true;
  std::unique_ptr<SteeringController> (*make)(const ControllerOptions& options);

  // Rules of the options. OnOptions adapts functions that take the options struct.

  /// Checks rules that relate several keys of the controller.
  std::vector<OptionProblem> (*check)(const ControllerOptions& options,
                                      const CouldReadKey& could_read) = nullptr;
  /// Returns the end of a run without a plan [s]. Null or nullopt: the controller does not set it.
  std::optional<double> (*duration)(const ControllerOptions& options) = nullptr;

  // Recorded inputs of controllers that replay them.

  /// Returns the recording that is replayed.
  const Recording& (*recording)(const ControllerOptions& options) = nullptr;
  /// Whether the controller replays the scenario's recorded drive instead of a file.
  bool (*replays_record)(const ControllerOptions& options) = nullptr;
  void (*set_recording)(ControllerOptions& options, const Recording& recording) = nullptr;

  // Input files of the options.

  /// Reads the files that the options name into the options.
  void (*read_inputs)(ControllerOptions& options, InputReader& reader) = nullptr;
  /// Returns the files of the options in the form that the run folder stores.
  std::vector<InputFile> (*input_files)(const ControllerOptions& options) = nullptr;
  std::vector<std::string> input_names{};  ///< All names that `input_files` may return.
  /// Changes the options to name the files of `input_files`. If the scenario's recorded drive is
  /// replayed, the options then name no file.
  void (*resolve)(ControllerOptions& options, bool from_record) = nullptr;
};

/// Implements ControllerEntry::make for a class that is constructed from its options.
template <typename Options, typename Controller>
std::unique_ptr<SteeringController> MakeBy(const ControllerOptions& options) {
  return std::make_unique<Controller>(options.Get<Options>());
}

}  // namespace trackbed
