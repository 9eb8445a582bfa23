#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trackbed/recording/recorded_drive.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/driver_aids.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/world/world.h"

/// Predicts a recorded drive over time windows. At the start of each window, a plant is set to the
/// recorded state; until the end of the window, the plant follows the recorded inputs.
namespace trackbed {

/// Options for replaying a recorded drive on a plant.
struct ReplayOptions {
  ReplaySteering steering = ReplaySteering::kCommand;
  ReplayDrive drive = ReplayDrive::kSpeed;
  double control_period = 0.01;  ///< Control period, a whole number of the car's timesteps [s].
  /// Gain of the speed controller on the speed error [1/s]. If the model lacks a deceleration a of
  /// the real car, the speed error is a/gain.
  double speed_gain = 20.0;
  TyreLaw tyre = TyreLaw::kAuto;  ///< Tyre model of the plant `mujoco`.
  SteeringInput input = SteeringInput::kActuator;
  AidOptions aids{};  ///< Driver aids of the plant `mujoco`.
  World world{};
  /// Function that returns true to stop the prediction; PredictWindows calls it once per window.
  std::function<bool()> interrupted{};
};

/// The predicted states of one window.
struct WindowPrediction {
  double start = 0.0;  ///< Start time of the window since the start of the drive [s].
  /// Predicted states at `start`, `start` + `control_period`, … until the end of the window. The
  /// member `time` of a state counts from the start of the drive. The list of predicted states ends
  /// before the end of the window if the simulation of the plant diverged.
  std::vector<VehicleState> states{};
  bool diverged = false;
};

/// Predicts the plant's states in a window from `restart` to `restart + horizon` [s], for each
/// start time in `restarts`. Returns the predicted windows in the order of `restarts`.
///
/// Restart times are rounded to whole control periods. At the start of a window, the plant has the
/// recorded pose, speed, lateral speed and yaw rate (StartFrom). The kinematic car starts with only
/// the recorded pose and speed. In MuJoCo, the springs of the car start with the deflection of a
/// car at rest. The steering actuator starts in the state, including dead time and backlash, that
/// results from the recorded commands since the start of the drive. The controller `playback`
/// computes the commands, in the same way as in a scenario that replays the whole drive (`record`).
///
/// Guarantees: the same arguments always yield the same states, bit for bit; the prediction of one
/// window does not depend on other windows. The car model is not changed, and several threads may
/// share the model. Throws InputError in the same cases as ReplayInputs and MakePlant. Throws
/// PreconditionError if the control period is not a whole number of timesteps, or if a window is
/// not within the drive. The computing time consists of the construction of one plant for each
/// window (0.1 ms for MuJoCo), the simulation steps of all windows, and 0.1 us per timestep of the
/// drive.
std::vector<WindowPrediction> PredictWindows(const CarModel& car, const std::string& plant,
                                             const RecordedDrive& drive,
                                             const std::vector<double>& restarts, double horizon,
                                             const ReplayOptions& options = {});

/// Returns the start times of windows of the length `horizon` [s], at multiples of `spacing` [s]
/// from the start of the drive. WindowStarts includes a window only if the window fits into the
/// drive, all its samples are valid, and its mean speed is at least `min_speed` [m/s].
std::vector<double> WindowStarts(const RecordedDrive& drive, double horizon, double spacing,
                                 double min_speed);

/// Errors of the predicted states compared with the recorded drive. Quantiles of an error are
/// computed over all windows, with linear interpolation between the two nearest values. Relative
/// errors are computed over all states at which the recorded speed is at least `min_speed`. The
/// relative error of a quantity is the root mean square of the prediction errors, divided by the
/// root mean square of the recorded quantity.
struct WindowErrors {
  double horizon = 0.0;  ///< Length of the prediction windows [s].
  int count = 0;         ///< Number of prediction windows.
  /// Number of windows in which the simulation diverged; the errors of these windows count as
  /// infinite.
  int diverged = 0;
  /// Median of the distance between the predicted and the recorded position at the end of a window
  /// [m].
  double position_median = 0.0;
  /// 90 % quantile of the distance between the predicted and the recorded position at the end of a
  /// window [m].
  double position_p90 = 0.0;
  /// Median of the absolute heading error at the end of a window [rad].
  double heading_median = 0.0;
  /// 90 % quantile of the absolute heading error at the end of a window [rad].
  double heading_p90 = 0.0;
  double yaw_rate_relative_rms = 0.0;  ///< Relative error of the predicted yaw rate [1].
  /// Relative error of the predicted lateral acceleration [1].
  double lateral_acceleration_relative_rms = 0.0;
};

/// Computes the prediction errors of windows. Throws PreconditionError if `windows` is empty.
WindowErrors MeasureWindows(const std::vector<WindowPrediction>& windows,
                            const RecordedDrive& drive, const VehicleParams& vehicle,
                            double horizon, double min_speed);

}  // namespace trackbed
