#pragma once

#include <optional>
#include <string>

#include "trackbed/control/signal.h"
#include "trackbed/control/steering_controller.h"

/// Recorded inputs that can be replayed on any plant.
namespace trackbed {

/// The independent variable of a recording.
enum class PlaybackAxis {
  kTime,      ///< Time since the start of the run [s].
  kDistance,  ///< Distance that the car has driven [m].
};

/// The inputs of a run, all over the same axis. Only one of speed and acceleration may be given.
/// Empty signals have no effect.
struct Recording {
  /// Steering angle of the bicycle model [rad], positive to the left; not empty.
  Signal steering{{{0.0, 0.0}}};
  Signal speed;         ///< Speed of the rear axle [m/s], >= 0.
  Signal acceleration;  ///< Rate of the speed, dv/dt [m/s^2].
};

/// The names of a recording's columns in its file. Defaults: `t_s`, `s_m`, `steering_rad`,
/// `speed_mps`, `acceleration_mps2`.
struct RecordingColumns {
  std::optional<std::string> time;
  std::optional<std::string> distance;
  std::optional<std::string> steering;
  std::optional<std::string> speed;
  std::optional<std::string> acceleration;
};
void Visit(KeyVisitor& keys, RecordingColumns& columns);

/// Replays a recording in open loop. In each period, the inputs are as follows (x the axis, T the
/// period):
///   steering      the recorded angle where the period ends, at t + T or D + abs(v) T
///   speed         its change over the period by T, plus gain times the speed error (SpeedAlong)
///   acceleration  its mean over the period
/// A car that follows commands exactly reproduces the recording at every control period. Values are
/// constant before the first row and after the last row. By distance, the car stays where the
/// recorded speed is zero.
struct PlaybackOptions {
  /// The file that was read. Empty for a recording made in code, or taken from a scenario's record.
  std::string file;
  PlaybackAxis by = PlaybackAxis::kTime;
  RecordingColumns columns;
  Recording recording;
};
void Visit(KeyVisitor& keys, PlaybackOptions& options);

/// The commanded angle [rad] after `period` [s], for a car with `speed` [m/s] at `x` on the axis.
double PlaybackSteering(const PlaybackOptions& options, double x, double speed, double period);

/// The commanded acceleration [m/s^2] over the period; nullopt if the recording has neither speed
/// nor acceleration.
std::optional<double> PlaybackAcceleration(const PlaybackOptions& options, double x, double speed,
                                           double gain, double period);

/// The controller `playback`.
ControllerEntry Playback();

}  // namespace trackbed
