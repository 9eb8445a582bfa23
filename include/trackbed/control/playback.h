#pragma once

#include <optional>
#include <string>

#include "trackbed/control/signal.h"
#include "trackbed/control/steering_controller.h"

/// Replays recorded inputs on any plant.
namespace trackbed {

/// The independent variable (axis) over which the inputs are recorded.
enum class PlaybackAxis {
  kTime,      ///< Time since the start of the run [s].
  kDistance,  ///< Distance that the car has driven [m].
};

/// Recorded inputs of a drive: steering, speed and acceleration over the same axis (time or
/// distance). A recording has a speed signal or an acceleration signal, but not both. If the speed
/// and the acceleration are both empty, the recording does not set the speed.
struct Recording {
  /// Steering angle of the bicycle model [rad], positive to the left. A recording without steering
  /// cannot be replayed.
  Signal steering;
  Signal speed;         ///< Speed of the rear axle [m/s], >= 0.
  Signal acceleration;  ///< Rate of change of the speed, dv/dt [m/s^2].
};

/// Names of the columns in the CSV file of a recording. The default names are `t_s`, `s_m`,
/// `steering_rad`, `speed_mps`, `acceleration_mps2`.
struct RecordingColumns {
  std::optional<std::string> time;
  std::optional<std::string> distance;
  std::optional<std::string> steering;
  std::optional<std::string> speed;
  std::optional<std::string> acceleration;
};
void Visit(KeyVisitor& keys, RecordingColumns& columns);

/// Replays a recording in open loop. In each control period of length T, the commands for steering,
/// speed and acceleration are as follows.
///   Steering: the command at the time t and the driven distance D is the recorded steering angle
///   at the end of the period, at t + T or at D + abs(v) T. Speed: the commanded acceleration is
///   the change of the recorded speed over the period, divided by the period T, plus the gain times
///   the speed error (SpeedAlong). Acceleration: the command is the mean of the recorded
///   acceleration over the control period.
/// A car that follows the commands exactly has the recorded values at the end of every control
/// period. Recorded values are treated as constant before the first row and after the last row. If
/// the recording's axis is the distance, the car never leaves a place where the recorded speed is
/// zero.
struct PlaybackOptions {
  /// Path of the file from which the recording was read. The file path is empty if the recording
  /// was made in code or taken from a scenario's record.
  std::string file;
  PlaybackAxis by = PlaybackAxis::kTime;
  RecordingColumns columns;
  Recording recording;
};
void Visit(KeyVisitor& keys, PlaybackOptions& options);

/// Returns the commanded steering angle [rad] at the end of the control period, for a car with
/// `speed` [m/s] at the value `x` of the recording's axis. The argument `period` is the length of
/// the control period [s].
double PlaybackSteering(const PlaybackOptions& options, double x, double speed, double period);

/// Returns the commanded acceleration [m/s^2] over the control period; nullopt if the recording has
/// neither speed nor acceleration.
std::optional<double> PlaybackAcceleration(const PlaybackOptions& options, double x, double speed,
                                           double gain, double period);

/// Returns the registry entry of the controller `playback`.
ControllerEntry Playback();

}  // namespace trackbed
