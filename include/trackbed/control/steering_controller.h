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

/// Interface of a steering controller. Steer returns the commanded angle of the bicycle model [rad]
/// at the end of the coming control period; the vehicle's actuator limits angle and rate. A
/// controller does no input or output, reads no clock, and draws random numbers only from a fixed
/// seed.
class SteeringController {
 public:
  virtual ~SteeringController() = default;
  virtual double Steer(const ControlInput& input) = 0;

  /// Returns the commanded acceleration [m/s^2] over the coming control period, which only the
  /// car's own limits restrict. Returns nullopt if the controller leaves the speed to SpeedControl.
  virtual std::optional<double> Accelerate(const ControlInput& input);

  /// Diagnostics of the last update, for the log. Columns returns the column names, which never
  /// change; Values returns one value per column. Both are empty by default.
  [[nodiscard]] virtual std::vector<std::string> Columns() const;
  [[nodiscard]] virtual std::vector<double> Values() const;
};

/// Source of the station on the path that a controller receives.
enum class StationSource {
  kProjection,  ///< Station of the path point nearest to the car (closed loop).
  kOdometer,    ///< Distance that the car has driven (open loop).
};

/// A controller in the registry (controllers.h). All function pointers except `make` may be null.
struct ControllerEntry {
  const char* name;
  const char* summary;  ///< One-line summary for users.
  ControllerOptions defaults;
  StationSource station = StationSource::kProjection;
  bool needs_plan = true;
  std::unique_ptr<SteeringController> (*make)(const ControllerOptions& options);

  // The following members check the options or derive data from them. The template OnOptions adapts
  // a function that takes the controller's own options struct.

  /// Checks rules that relate several option keys of the controller.
  std::vector<OptionProblem> (*check)(const ControllerOptions& options,
                                      const CouldReadKey& could_read) = nullptr;
  /// Returns the time at which a run without a plan ends [s]. If the pointer is null or the
  /// function returns nullopt, the controller does not end the run.
  std::optional<double> (*duration)(const ControllerOptions& options) = nullptr;

  // The following members belong to controllers that replay recorded inputs.

  /// Returns the recording that the controller replays.
  const Recording& (*recording)(const ControllerOptions& options) = nullptr;
  /// Whether the controller replays the scenario's recorded drive instead of a file.
  bool (*replays_record)(const ControllerOptions& options) = nullptr;
  void (*set_recording)(ControllerOptions& options, const Recording& recording) = nullptr;

  // The following members handle the input files that the options name.

  /// Reads the files that the options name, and stores their contents in the options.
  void (*read_inputs)(ControllerOptions& options, InputReader& reader) = nullptr;
  /// Returns the input files of the options, as copies that are written to the run folder.
  std::vector<InputFile> (*input_files)(const ControllerOptions& options) = nullptr;
  std::vector<std::string> input_names{};  ///< All names that `input_files` may return.
  /// Changes the file names in the options to the names of the files from `input_files`. If the
  /// controller replays the scenario's recorded drive (`from_record`), clears the file names
  /// instead.
  void (*resolve)(ControllerOptions& options, bool from_record) = nullptr;
};

/// Implements ControllerEntry::make for a class that is constructed from its options.
template <typename Options, typename Controller>
std::unique_ptr<SteeringController> MakeBy(const ControllerOptions& options) {
  return std::make_unique<Controller>(options.Get<Options>());
}

}  // namespace trackbed
