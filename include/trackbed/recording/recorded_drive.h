#pragma once

#include <string>
#include <vector>

#include "trackbed/control/playback.h"
#include "trackbed/control/signal.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

/// A recorded drive of a real vehicle, on a uniform time grid.
namespace trackbed {

/// One sample of a recorded drive. The vehicle frame V has its origin on the ground under the rear
/// axle's center, x forward and y to the left. The values do not depend on a model of the vehicle.
struct RecordedSample {
  double time = 0.0;               ///< Time since the first sample [s].
  Pose2 pose{};                    ///< Pose X_WV; the yaw is not wrapped.
  Vec2 velocity_V = Vec2::Zero();  ///< Velocity of V's origin over the ground, in axes of V [m/s].
  double yaw_rate = 0.0;           ///< Yaw rate [rad/s].
  /// Acceleration of V's origin over the ground, in axes of V [m/s^2].
  Vec2 acceleration_V = Vec2::Zero();
  double yaw_acceleration = 0.0;  ///< Yaw acceleration [rad/s^2].
  double steering = 0.0;  ///< Measured angle of the road wheels [rad], positive to the left.
  double steering_command = 0.0;  ///< Command received by the car's steering actuator [rad].
  double throttle = 0.0;          ///< Drive command, as an acceleration [m/s^2].
  bool valid = true;  ///< Whether the sample is valid; samples in gaps of the log are not.
};

/// A recorded drive. The drive has at least two uniform samples, the first one at time 0.
struct RecordedDrive {
  std::string name;     ///< Name of the file, without its extension.
  double period = 0.0;  ///< Time between samples [s].
  std::vector<RecordedSample> samples{};
  bool has_steering = false;          ///< Whether the samples have a measured steering angle.
  bool has_steering_command = false;  ///< Whether the samples have a steering command.
  bool has_throttle = false;          ///< Whether the samples have a drive command.
  std::vector<std::string> notes{};   ///< Processing steps and remarks.

  [[nodiscard]] double duration() const { return samples.back().time; }
  /// The fraction of valid samples.
  [[nodiscard]] double valid_fraction() const;
  /// Returns the sample at a time, interpolated linearly between samples and constant beyond the
  /// ends. The result is valid if both neighboring samples are valid. Cost O(1).
  [[nodiscard]] RecordedSample At(double time) const;
};

/// Converts a sample to a state of the given vehicle. Speeds and accelerations are those of the
/// vehicle's center of gravity:
///   v_y = v_y(V) + l r,  a_x = a_x(V) - l r^2,  a_y = a_y(V) + l r',
/// with l the distance from the rear axle to the center of gravity. If `measured` is true, the
/// steering is the measured angle, else the command. `distance` stays 0; sideslip is 0 below
/// kAtRestSpeed.
VehicleState StateOf(const RecordedSample& sample, const VehicleParams& vehicle, bool measured);

/// Returns the state in which a plant starts at the sample, with its wheels at `steering` [rad] and
/// with the recorded yaw rate and lateral speed. Below 0.2 m/s, noise dominates the recorded
/// direction of motion, so the car starts without slip. If the recorded car goes backwards, the
/// start is at rest.
StartState StartFrom(const RecordedSample& sample, double steering);

/// The steering input of a replay.
enum class ReplaySteering {
  kCommand,  ///< Recorded command, applied through the car's steering response.
  /// Recorded angle of the road wheels, applied as a command through the steering response.
  kMeasured,
};

/// The longitudinal input of a replay.
enum class ReplayDrive {
  /// Recorded speed: the acceleration command is the rate of change of the recorded speed, plus a
  /// gain times the speed error.
  kSpeed,
  kThrottle,  ///< Recorded drive command, as an acceleration.
};

/// The inputs of a replay over time, for the controller `playback`. InputError if the drive lacks
/// the selected signal. With kSpeed, InputError if the car goes backwards faster than 0.05 m/s in a
/// valid sample, because a replay only drives forward.
Recording ReplayInputs(const RecordedDrive& drive, ReplaySteering steering, ReplayDrive source);

}  // namespace trackbed
