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

/// One moment of a recorded drive. V is the vehicle frame: origin on the ground under the rear
/// axle's center, x forward, y left. Nothing here depends on a model of the vehicle.
struct RecordedSample {
  double time = 0.0;                   ///< since the first sample [s]
  Pose2 pose{};                        ///< X_WV; yaw is not wrapped
  Vec2 velocity_V = Vec2::Zero();      ///< of V's origin over the ground, in axes of V [m/s]
  double yaw_rate = 0.0;               ///< [rad/s]
  Vec2 acceleration_V = Vec2::Zero();  ///< of V's origin over the ground, in axes of V [m/s^2]
  double yaw_acceleration = 0.0;       ///< [rad/s^2]
  double steering = 0.0;               ///< measured at the road wheels [rad], positive left
  double steering_command = 0.0;       ///< as the car's steering actuator gets it [rad]
  double throttle = 0.0;               ///< command of the drive, as an acceleration [m/s^2]
  bool valid = true;                   ///< false in a gap: then interpolated over the gap
};

/// Uniform samples, at least two; the first at time 0.
struct RecordedDrive {
  std::string name;     ///< of the file, without its extension
  double period = 0.0;  ///< between samples [s]
  std::vector<RecordedSample> samples{};
  bool has_steering = false;          ///< whether the samples have a measured steering angle
  bool has_steering_command = false;  ///< likewise
  bool has_throttle = false;          ///< likewise
  std::vector<std::string> notes{};   ///< what was done to get here, for people

  [[nodiscard]] double duration() const { return samples.back().time; }
  /// The share of the samples that are valid.
  [[nodiscard]] double valid_fraction() const;
  /// Linear between samples, held beyond the ends; valid where both neighbors are. Cost O(1).
  [[nodiscard]] RecordedSample At(double time) const;
};

/// The sample as a state of that vehicle: speeds and accelerations moved to its center of gravity,
///   v_y = v_y(V) + l r,  a_x = a_x(V) - l r^2,  a_y = a_y(V) + l r',
/// l from the rear axle to the center of gravity. Steering is the measured angle if `measured`,
/// else the command. `distance` stays 0; sideslip is 0 below kAtRestSpeed.
VehicleState StateOf(const RecordedSample& sample, const VehicleParams& vehicle, bool measured);

/// The start of a plant at the sample, with its wheels at `steering` [rad]: with the recorded yaw
/// rate and lateral speed, unless the car is slower than 0.2 m/s, where the direction in which it
/// seems to move is that of the noise; then it rolls without slip. At rest if it goes backwards.
StartState StartFrom(const RecordedSample& sample, double steering);

/// What a replay steers with.
enum class ReplaySteering {
  kCommand,   ///< the recorded command, through the car's steering response
  kMeasured,  ///< the recorded angle of the road wheels, as a command likewise
};

/// What a replay drives with.
enum class ReplayDrive {
  kSpeed,     ///< the recorded speed: its change, and a gain on the speed error
  kThrottle,  ///< the recorded command of the drive, as an acceleration
};

/// The inputs of a replay over time, as the controller `playback` takes them. InputError when the
/// drive lacks the signal; or, with kSpeed, where the car goes backwards faster than 0.05 m/s in a
/// valid sample: a replay drives forward only.
Recording ReplayInputs(const RecordedDrive& drive, ReplaySteering steering, ReplayDrive source);

}  // namespace trackbed
