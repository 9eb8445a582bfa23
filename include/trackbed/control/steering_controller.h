#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/control/speed_controller.h"
#include "trackbed/options/method_options.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/vehicle/steering_schedule.h"

/// The interface of everything that steers.
namespace trackbed {

/// What a controller may look at when it is asked, once per control period.
struct ControlInput {
  const VehicleParams& vehicle;
  const Reference& reference;
  const SteeringSchedule& schedule;
  VehicleState state;
  double station = 0.0;    ///< where on the path the car is [m]; see StationSource
  double period = 0.0;     ///< until it is asked again [s]
  double plan_time = 0.0;  ///< since the plan was taken up [s]
  double speed_gain = SpeedControlOptions{}.gain;  ///< for those that set the speed too [1/s]
};

/// Gives the wanted bicycle angle [rad] at the end of the coming period; the vehicle's actuator
/// limits angle and rate. A controller does no input or output, reads no clock, and draws random
/// numbers from a fixed seed alone.
class SteeringController {
 public:
  virtual ~SteeringController() = default;
  virtual double Steer(const ControlInput& input) = 0;

  /// The wanted acceleration [m/s^2] over the coming period, which only the car's own limits cut.
  /// None: the speed is not the controller's business, SpeedControl keeps it.
  virtual std::optional<double> Accelerate(const ControlInput& input);

  /// What it tells of its last answer, for the log: the columns' names, always the same, and one
  /// value for each. None by default.
  [[nodiscard]] virtual std::vector<std::string> Columns() const;
  [[nodiscard]] virtual std::vector<double> Values() const;
};

/// The options of a controller. The type of the struct that it holds identifies the controller.
using ControllerOptions = MethodOptions<SteeringController>;

/// Where a controller takes the station from.
enum class StationSource {
  kProjection,  ///< the nearest point of the path: closes the loop
  kOdometer,    ///< the distance driven: open loop
};

/// A controller in the registry (controllers.h).
struct ControllerEntry {
  const char* name;
  const char* summary;  ///< for people, on one line
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
