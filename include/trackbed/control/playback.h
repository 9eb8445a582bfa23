#pragma once

#include <optional>
#include <string>

#include "trackbed/control/signal.h"
#include "trackbed/control/steering_controller.h"

/// Recorded inputs, replayed on any plant.
namespace trackbed {

/// The independent variable of a recording.
enum class PlaybackAxis {
  kTime,      ///< since the start of the run [s]
  kDistance,  ///< that the car has driven [m]
};

/// The inputs of a run, all over the same axis. At most one of speed and acceleration may be given;
/// empty signals have no effect.
struct Recording {
  Signal steering{{{0.0, 0.0}}};  ///< bicycle angle [rad], positive to the left; not empty
  Signal speed;                   ///< of the rear axle [m/s], >= 0
  Signal acceleration;            ///< dv/dt [m/s^2]
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

/// A recording replayed, open loop, over the coming period (x the axis, T the period):
///   steering      the recorded angle where the period ends, at t + T or D + abs(v) T
///   speed         its change over the period by T, plus gain times the speed error (SpeedAlong)
///   acceleration  its mean over the period
/// A car that follows commands exactly thus reproduces the recording at every control period.
/// Values are constant before the first row and after the last. By distance, the car stays where
/// the recorded speed is zero.
struct PlaybackOptions {
  /// The file that was read; empty for the recording of a scenario's record, or one made in code.
  std::string file;
  PlaybackAxis by = PlaybackAxis::kTime;
  RecordingColumns columns;
  Recording recording;
};
void Visit(KeyVisitor& keys, PlaybackOptions& options);

/// The commanded angle [rad] after `period` [s], for a car with `speed` [m/s] at `x` on the axis.
double PlaybackSteering(const PlaybackOptions& options, double x, double speed, double period);

/// The commanded acceleration [m/s^2] over the period; none if the recording has neither speed nor
/// acceleration.
std::optional<double> PlaybackAcceleration(const PlaybackOptions& options, double x, double speed,
                                           double gain, double period);

/// The controller `playback`.
ControllerEntry Playback();

}  // namespace trackbed
