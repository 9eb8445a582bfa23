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
  double control_period = 0.01;  ///< a whole number of the car's timesteps [s]
  /// Gain on the speed error [1/s]: a plant with an unmodeled deceleration a stays a/gain slower
  /// than the recorded speed.
  double speed_gain = 20.0;
  TyreLaw tyre = TyreLaw::kAuto;  ///< of the plant `mujoco`
  SteeringInput input = SteeringInput::kActuator;
  World world{};
  std::function<bool()> interrupted{};  ///< polled once per window; ends the work early
};

/// One window.
struct WindowPrediction {
  double start = 0.0;  ///< time in the drive [s]
  /// States at start, start + control_period, … to the window's end; `time` counts from the drive's
  /// start. Fewer if the plant diverged.
  std::vector<VehicleState> states{};
  bool diverged = false;
};

/// The plant's states over [restart, restart + horizon] for each of `restarts` [s], in the same
/// order.
///
/// Restart times are rounded to whole control periods. At a restart, the plant has the recorded
/// pose, speed, lateral speed and yaw rate (StartFrom; the kinematic car only pose and speed;
/// MuJoCo's car stands on its springs as at rest). The steering actuator has the state that the
/// recorded commands since the start of the drive produce, including dead time and backlash.
/// Commands are those of the controller `playback`, as in a scenario with `record`, which replays
/// the whole drive.
///
/// Guarantees: the same arguments give the same states, bit for bit; windows are independent of
/// each other. The car is not changed, and several threads may share it. Errors: InputError as
/// ReplayInputs and MakePlant; PreconditionError for a control period that is not a whole number of
/// timesteps, or a restart or horizon outside of the drive. Cost: one plant for each window
/// (MuJoCo's: 0.1 ms), the steps of all windows, and 0.1 us per timestep of the drive.
std::vector<WindowPrediction> PredictWindows(const CarModel& car, const std::string& plant,
                                             const RecordedDrive& drive,
                                             const std::vector<double>& restarts, double horizon,
                                             const ReplayOptions& options = {});

/// Starts of windows of `horizon` [s], at multiples of `spacing` [s] from the start of the drive:
/// those whose window fits into the drive, has only valid samples, and has a mean speed of at least
/// `min_speed` [m/s].
std::vector<double> WindowStarts(const RecordedDrive& drive, double horizon, double spacing,
                                 double min_speed);

/// Errors of predictions relative to the record. Quantiles are taken over the windows, linearly
/// interpolated between the two nearest values. Relative errors are over all states of all windows
/// at which the recorded speed is at
/// least `min_speed`: root mean square of the difference over that of the recorded quantity.
struct WindowErrors {
  double horizon = 0.0;                ///< [s]
  int count = 0;                       ///< number of windows
  int diverged = 0;                    ///< diverged windows; they count as infinitely far away
  double position_median = 0.0;        ///< of the distance at the window's end [m]
  double position_p90 = 0.0;           ///< of the distance at the window's end [m]
  double heading_median = 0.0;         ///< of the absolute heading error at the window's end [rad]
  double heading_p90 = 0.0;            ///< of the absolute heading error at the window's end [rad]
  double yaw_rate_relative_rms = 0.0;  ///< [1]
  double lateral_acceleration_relative_rms = 0.0;  ///< [1]
};

/// PreconditionError if there are no windows.
WindowErrors MeasureWindows(const std::vector<WindowPrediction>& windows,
                            const RecordedDrive& drive, const VehicleParams& vehicle,
                            double horizon, double min_speed);

}  // namespace trackbed
