#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/control/controller_options.h"
#include "trackbed/control/speed_controller.h"
#include "trackbed/options/method_options.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/vehicle/steering_schedule.h"

/// The interface of steering controllers.
namespace trackbed {

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

/// Gives the commanded bicycle angle [rad] at the end of the coming period; the vehicle's actuator
/// limits angle and rate. A controller does no input or output, reads no clock, and draws random
/// numbers from a fixed seed alone.
class SteeringController {
 public:
  virtual ~SteeringController() = default;
  virtual double Steer(const ControlInput& input) = 0;

  /// The commanded acceleration [m/s^2] over the coming period, limited only by the car. None:
  /// SpeedControl sets the speed.
  virtual std::optional<double> Accelerate(const ControlInput& input);

  /// Diagnostics of the last update, for the log: column names, always the same, and one value for
  /// each. None by default.
  [[nodiscard]] virtual std::vector<std::string> Columns() const;
  [[nodiscard]] virtual std::vector<double> Values() const;
};

/// The source of a controller's station.
enum class StationSource {
  kProjection,  ///< the nearest point of the path: closes the loop
  kOdometer,    ///< the distance driven: open loop
};

/// A controller in the registry (controllers.h).
struct ControllerEntry {
  const char* name;
  const char* summary;  ///< one line, for users
  ControllerOptions defaults;
  StationSource station = StationSource::kProjection;
  bool needs_plan = true;
  std::unique_ptr<SteeringController> (*make)(const ControllerOptions& options);
};

/// A ControllerEntry::make for a class that is constructed from its options.
template <typename Options, typename Controller>
std::unique_ptr<SteeringController> MakeBy(const ControllerOptions& options) {
  return std::make_unique<Controller>(options.Get<Options>());
}

}  // namespace trackbed
