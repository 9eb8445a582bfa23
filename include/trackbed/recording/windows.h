#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trackbed/recording/recorded_drive.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/world/world.h"

/// Prediction of a recorded drive over windows: a plant restarts again and again at the recorded
/// state, and is driven by the recorded inputs for a while.
namespace trackbed {

/// How a recording is replayed on a plant.
struct ReplayOptions {
  ReplaySteering steering = ReplaySteering::kCommand;
  ReplayDrive drive = ReplayDrive::kSpeed;
  double control_period = 0.01;  ///< a whole number of the car's timesteps [s]
  /// On the speed error [1/s]: a plant that is slowed by a falls short of the recorded speed by
  /// a/gain.
  double speed_gain = 20.0;
  TyreLaw tyre = TyreLaw::kAuto;  ///< of the plant `mujoco`
  SteeringInput input = SteeringInput::kActuator;
  World world{};
  std::function<bool()> interrupted{};  ///< asked once per window; ends the work early
};

/// One window.
struct WindowPrediction {
  double start = 0.0;  ///< in the drive [s]
  /// At start, start + control_period, … to the window's end; `time` counts from the drive's start.
  /// Fewer where the plant diverged.
  std::vector<VehicleState> states{};
  bool diverged = false;
};

/// The plant's states over [restart, restart + horizon] for each of `restarts` [s], in their order.
///
/// Restart times are rounded to whole control periods. There the plant has the recorded pose,
/// speed, lateral speed and yaw rate (StartFrom; the kinematic car only pose and speed, MuJoCo's
/// car stands on its springs as at rest), and the steering actuator is where the recorded commands
/// since the start of the drive have brought it, dead time and backlash included. Commands are
/// those of the controller `playback`: what a scenario with `record` replays over the whole drive.
///
/// Guarantees: the same arguments give the same states, bit for bit; a window does not depend on
/// the others. The car is not changed, and several threads may predict with one. Errors:
/// InputError as ReplayInputs and MakePlant; PreconditionError for a control period that is no
/// whole number of timesteps, or a restart or horizon out of the drive.
/// Cost: one plant for each window (MuJoCo's: 0.1 ms), the steps of all windows, and 0.1 us per
/// timestep of the drive.
std::vector<WindowPrediction> PredictWindows(const CarModel& car, const std::string& plant,
                                             const RecordedDrive& drive,
                                             const std::vector<double>& restarts, double horizon,
                                             const ReplayOptions& options = {});

/// Every `spacing` [s] from the start of the drive: where a window of `horizon` [s] fits in, all of
/// whose samples are valid and whose mean speed is at least `min_speed` [m/s].
std::vector<double> WindowStarts(const RecordedDrive& drive, double horizon, double spacing,
                                 double min_speed);

/// How far predictions are from the record. Quantiles are over windows, linear between the two
/// nearest; relative errors are over all states of all windows in which the recorded speed is at
/// least `min_speed`: root mean square of the difference over that of the recorded quantity.
struct WindowErrors {
  double horizon = 0.0;                            ///< [s]
  int count = 0;                                   ///< windows
  int diverged = 0;                                ///< of them; they count as infinitely far away
  double position_median = 0.0;                    ///< of the distance at the window's end [m]
  double position_p90 = 0.0;                       ///< likewise
  double heading_median = 0.0;                     ///< of the heading's error there, unsigned [rad]
  double heading_p90 = 0.0;                        ///< likewise
  double yaw_rate_relative_rms = 0.0;              ///< [1]
  double lateral_acceleration_relative_rms = 0.0;  ///< [1]
};

/// PreconditionError when there are no windows.
WindowErrors MeasureWindows(const std::vector<WindowPrediction>& windows,
                            const RecordedDrive& drive, const VehicleParams& vehicle,
                            double horizon, double min_speed);

}  // namespace trackbed
