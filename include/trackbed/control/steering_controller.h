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

/// The input of a controller, once per control period.
struct ControlInput {
  const VehicleParams& vehicle;
  const Reference& reference;
  const SteeringSchedule& schedule;
  VehicleState state;
  double station = 0.0;    ///< station of the car on the path [m]; see StationSource
  double period = 0.0;     ///< control period [s]
  double plan_time = 0.0;  ///< since the plan took effect [s]
  double speed_gain =
      SpeedControlOptions{}.gain;  ///< for controllers that also set the speed [1/s]
};

/// Returns the commanded bicycle angle [rad] at the end of the coming period; the vehicle's
/// actuator limits angle and rate. A controller does no input or output, reads no clock, and draws
/// random numbers only from a fixed seed.
class SteeringController {
 public:
  virtual ~SteeringController() = default;
  virtual double Steer(const ControlInput& input) = 0;

  /// The commanded acceleration [m/s^2] over the coming period, limited only by the car. None:
  /// SpeedControl sets the speed.
  virtual std::optional<double> Accelerate(const ControlInput& input);

  /// Diagnostics of the last update, for the log: constant column names, and one value per column.
  /// Empty by default.
  [[nodiscard]] virtual std::vector<std::string> Columns() const;
  [[nodiscard]] virtual std::vector<double> Values() const;
};

/// The source of a controller's station.
enum class StationSource {
  kProjection,  ///< the nearest point of the path: closes the loop
  kOdometer,    ///< the distance driven: open loop
};

/// A controller in the registry (controllers.h). The functions may be null, except `make`.
struct ControllerEntry {
  const char* name;
  const char* summary;  ///< one line, for users
  ControllerOptions defaults;
  StationSource station = StationSource::kProjection;
  bool needs_plan = true;
  std::unique_ptr<SteeringController> (*make)(const ControllerOptions& options);

  // Rules of the options. OnOptions adapts functions that take the options struct.

  /// Rules between the controller's keys.
  std::vector<OptionProblem> (*check)(const ControllerOptions& options,
                                      const CouldReadKey& could_read) = nullptr;
  /// End of a run without a plan [s]; null, or none: not set by the controller.
  std::optional<double> (*duration)(const ControllerOptions& options) = nullptr;

  // Recorded inputs, for controllers that replay them.

  /// The recording that is replayed.
  const Recording& (*recording)(const ControllerOptions& options) = nullptr;
  /// Whether the scenario's recorded drive, if any, is replayed instead of a file.
  bool (*replays_record)(const ControllerOptions& options) = nullptr;
  void (*set_recording)(ControllerOptions& options, const Recording& recording) = nullptr;

  // Files.

  /// Reads the files that the options name into the options.
  void (*read_inputs)(ControllerOptions& options, InputReader& reader) = nullptr;
  /// The files of the options as the run folder keeps them.
  std::vector<InputFile> (*input_files)(const ControllerOptions& options) = nullptr;
  std::vector<std::string> input_names{};  ///< every name that `input_files` may return
  /// Changes the options to name the files of `input_files`, or none if the scenario's recorded
  /// drive is replayed.
  void (*resolve)(ControllerOptions& options, bool from_record) = nullptr;
};

/// A ControllerEntry::make for a class that is constructed from its options.
template <typename Options, typename Controller>
std::unique_ptr<SteeringController> MakeBy(const ControllerOptions& options) {
  return std::make_unique<Controller>(options.Get<Options>());
}

}  // namespace trackbed
