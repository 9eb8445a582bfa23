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
/// axle's center; the x axis points forward and the y axis points to the left. The values of the
/// sample do not depend on a model of the vehicle.
struct RecordedSample {
  double time = 0.0;  ///< Time since the first sample [s].
  /// Pose X_WV of the vehicle frame in the world; the yaw is not wrapped.
  Pose2 pose{};
  /// Velocity over the ground of the origin of the vehicle frame V, in the axes of V [m/s].
  Vec2 velocity_V = Vec2::Zero();
  double yaw_rate = 0.0;  ///< Yaw rate [rad/s].
  /// Acceleration over the ground of the origin of the vehicle frame V, in the axes of V [m/s^2].
  Vec2 acceleration_V = Vec2::Zero();
  double yaw_acceleration = 0.0;  ///< Yaw acceleration [rad/s^2].
  double steering = 0.0;  ///< Measured angle of the road wheels [rad], positive to the left.
  /// Steering angle that was commanded to the car's steering actuator [rad].
  double steering_command = 0.0;
  /// Drive command of the recorded car, expressed as an acceleration [m/s^2].
  double throttle = 0.0;
  bool valid = true;  ///< Whether the sample is valid; samples in gaps of the log are invalid.
};

/// A recorded drive with at least two evenly spaced samples, the first at time 0.
struct RecordedDrive {
  std::string name;     ///< Name of the log file, without the extension.
  double period = 0.0;  ///< Time between two samples [s].
  std::vector<RecordedSample> samples{};
  bool has_steering = false;          ///< Whether the samples have a measured steering angle.
  bool has_steering_command = false;  ///< Whether the samples have a steering command.
  bool has_throttle = false;          ///< Whether the samples have a drive command.
  /// Remarks on the recorded drive, and the processing steps of the import.
  std::vector<std::string> notes{};

  [[nodiscard]] double duration() const { return samples.back().time; }
  /// Returns the fraction of the samples that are valid.
  [[nodiscard]] double valid_fraction() const;
  /// Returns the sample at the given time, interpolated linearly between samples and constant
  /// beyond the first and last sample. The interpolated sample is valid if both neighboring samples
  /// are valid. Cost O(1).
  [[nodiscard]] RecordedSample At(double time) const;
};

/// Converts a recorded sample to a state of the given vehicle. The speeds and accelerations in the
/// state are those of the vehicle's center of gravity:
///   v_y = v_y(V) + l r,  a_x = a_x(V) - l r^2,  a_y = a_y(V) + l r',
/// where l is the distance from the rear axle to the center of gravity and r is the yaw rate. If
/// `measured` is true, the state's steering angle is the measured angle, otherwise the commanded
/// angle. The traveled distance in the state is 0, and the sideslip angle is 0 below kAtRestSpeed.
VehicleState StateOf(const RecordedSample& sample, const VehicleParams& vehicle, bool measured);

/// Returns the initial state of a plant that starts at the given sample. The plant has the recorded
/// pose, speed, lateral speed and yaw rate, and the wheel angle `steering` [rad]. Below 0.2 m/s,
/// the recorded direction of motion is mostly noise, so the car then starts without sideslip. If
/// the recorded car moves backwards at the sample, the plant starts at rest.
StartState StartFrom(const RecordedSample& sample, double steering);

/// The recorded signal that a replay uses to steer the plant.
enum class ReplaySteering {
  /// The replay applies the recorded steering command through the steering response of the
  /// simulated car.
  kCommand,
  /// The replay uses the recorded angle of the road wheels as the steering command, applied through
  /// the steering response of the simulated car.
  kMeasured,
};

/// The recorded signal that a replay uses to control the speed of the plant.
enum class ReplayDrive {
  /// The replay follows the recorded speed: the acceleration command is the rate of change of the
  /// recorded speed, plus a gain times the speed error.
  kSpeed,
  kThrottle,  ///< The replay applies the recorded drive command as an acceleration.
};

/// Returns the inputs of a replay as functions of time, for the controller `playback`. Throws
/// InputError if the drive lacks the selected signal. With kSpeed, also throws InputError if the
/// recorded car moves backwards faster than 0.05 m/s in a valid sample, because a replay only
/// drives forward.
Recording ReplayInputs(const RecordedDrive& drive, ReplaySteering steering, ReplayDrive source);

}  // namespace trackbed
