#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trackbed/recording/recorded_drive.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/world/world.h"

/// Prediction of a recorded drive over windows: a plant repeatedly restarts at the recorded state,
/// and follows the recorded inputs until the window ends.
namespace trackbed {

/// How a recording is replayed on a plant.
struct ReplayOptions {
  ReplaySteering steering = ReplaySteering::kCommand;
  ReplayDrive drive = ReplayDrive::kSpeed;
  double control_period = 0.01;  ///< Control period, a whole number of the car's timesteps [s].
  /// Gain on the speed error [1/s]. With an unmodeled deceleration a, the plant is slower than the
  /// recorded speed by a/gain.
  double speed_gain = 20.0;
  TyreLaw tyre = TyreLaw::kAuto;  ///< Tyre law of the plant `mujoco`.
  SteeringInput input = SteeringInput::kActuator;
  World world{};
  std::function<bool()> interrupted{};  ///< Returns whether to stop; called once per window.
};

/// The predicted states of one window.
struct WindowPrediction {
  double start = 0.0;  ///< Start time in the drive [s].
  /// States at start, start + control_period, … to the window's end. The member `time` counts from
  /// the drive's start. There are fewer states if the plant diverged.
  std::vector<VehicleState> states{};
  bool diverged = false;
};

/// Predicts the plant's states over [restart, restart + horizon] for each of `restarts` [s], in the
/// same order.
///
/// Restart times are rounded to whole control periods. At a restart, the plant has the recorded
/// pose, speed, lateral speed and yaw rate (StartFrom). The kinematic car only has the recorded
/// pose and speed. In MuJoCo, the car stands on its springs as at rest. The steering actuator has
/// the state that results from the recorded commands since the start of the drive, including dead
/// time and backlash. Commands are those of the controller `playback`, as in a scenario with
/// `record`, which replays the whole drive.
///
/// Guarantees: the same arguments give the same states, bit for bit; windows are independent of
/// each other. The car is not changed, and several threads may share it. Errors: the InputErrors of
/// ReplayInputs and MakePlant; PreconditionError for a control period that is not a whole number of
/// timesteps, or a restart or horizon outside of the drive. Cost: the construction of one plant for
/// each window (0.1 ms for MuJoCo), the steps of all windows, and 0.1 us per timestep of the drive.
std::vector<WindowPrediction> PredictWindows(const CarModel& car, const std::string& plant,
                                             const RecordedDrive& drive,
                                             const std::vector<double>& restarts, double horizon,
                                             const ReplayOptions& options = {});

/// Returns the start times of windows of the length `horizon` [s], at multiples of `spacing` [s]
/// from the start of the drive. Includes only windows that fit into the drive, have only valid
/// samples, and have a mean speed of at least `min_speed` [m/s].
std::vector<double> WindowStarts(const RecordedDrive& drive, double horizon, double spacing,
                                 double min_speed);

/// Errors of predictions relative to the record. Quantiles are over the windows, interpolated
/// linearly between the two nearest values. Relative errors include the states of all windows at
/// which the recorded speed is at least `min_speed`. A relative error is the root mean square of
/// the difference divided by that of the recorded quantity.
struct WindowErrors {
  double horizon = 0.0;          ///< Length of the windows [s].
  int count = 0;                 ///< Number of windows.
  int diverged = 0;              ///< Number of diverged windows, whose errors count as infinite.
  double position_median = 0.0;  ///< Median of the distance at the window's end [m].
  double position_p90 = 0.0;     ///< 90 % quantile of the distance at the window's end [m].
  double heading_median = 0.0;  ///< Median of the absolute heading error at the window's end [rad].
  /// 90 % quantile of the absolute heading error at the window's end [rad].
  double heading_p90 = 0.0;
  double yaw_rate_relative_rms = 0.0;  ///< Relative error of the yaw rate [1].
  /// Relative error of the lateral acceleration [1].
  double lateral_acceleration_relative_rms = 0.0;
};

/// Measures the errors of windows. PreconditionError if there are no windows.
WindowErrors MeasureWindows(const std::vector<WindowPrediction>& windows,
                            const RecordedDrive& drive, const VehicleParams& vehicle,
                            double horizon, double min_speed);

}  // namespace trackbed
