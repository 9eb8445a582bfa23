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

/// One sample of a recorded drive. V is the vehicle frame: origin on the ground under the rear
/// axle's center, x forward, y left. The values do not depend on a model of the vehicle.
struct RecordedSample {
  double time = 0.0;                   ///< since the first sample [s]
  Pose2 pose{};                        ///< X_WV; yaw is not wrapped
  Vec2 velocity_V = Vec2::Zero();      ///< of V's origin over the ground, in axes of V [m/s]
  double yaw_rate = 0.0;               ///< [rad/s]
  Vec2 acceleration_V = Vec2::Zero();  ///< of V's origin over the ground, in axes of V [m/s^2]
  double yaw_acceleration = 0.0;       ///< [rad/s^2]
  double steering = 0.0;               ///< measured at the road wheels [rad], positive left
  double steering_command = 0.0;       ///< as received by the car's steering actuator [rad]
  double throttle = 0.0;               ///< drive command, as an acceleration [m/s^2]
  bool valid = true;                   ///< false in a gap, in which the sample is interpolated
};

/// Uniform samples, at least two; the first at time 0.
struct RecordedDrive {
  std::string name;     ///< of the file, without its extension
  double period = 0.0;  ///< between samples [s]
  std::vector<RecordedSample> samples{};
  bool has_steering = false;          ///< the samples have a measured steering angle
  bool has_steering_command = false;  ///< the samples have a steering command
  bool has_throttle = false;          ///< the samples have a drive command
  std::vector<std::string> notes{};   ///< processing steps and remarks

  [[nodiscard]] double duration() const { return samples.back().time; }
  /// The fraction of valid samples.
  [[nodiscard]] double valid_fraction() const;
  /// Linear between samples, constant beyond the ends; valid if both neighbors are. Cost O(1).
  [[nodiscard]] RecordedSample At(double time) const;
};

/// The sample as a state of the given vehicle: speeds and accelerations at its center of gravity,
///   v_y = v_y(V) + l r,  a_x = a_x(V) - l r^2,  a_y = a_y(V) + l r',
/// with l the distance from the rear axle to the center of gravity. Steering is the measured angle
/// if `measured`, else the command. `distance` stays 0; sideslip is 0 below kAtRestSpeed.
VehicleState StateOf(const RecordedSample& sample, const VehicleParams& vehicle, bool measured);

/// The start of a plant at the sample, with its wheels at `steering` [rad], and the recorded yaw
/// rate and lateral speed. Below 0.2 m/s, where noise dominates the recorded direction of motion,
/// the car rolls without slip instead. At rest if the recorded car goes backwards.
StartState StartFrom(const RecordedSample& sample, double steering);

/// The steering input of a replay.
enum class ReplaySteering {
  kCommand,   ///< the recorded command, through the car's steering response
  kMeasured,  ///< the recorded angle of the road wheels, as a command through that response
};

/// The longitudinal input of a replay.
enum class ReplayDrive {
  kSpeed,     ///< the recorded speed: its change, plus a gain on the speed error
  kThrottle,  ///< the recorded drive command, as an acceleration
};

/// The inputs of a replay over time, for the controller `playback`. InputError when the drive lacks
/// the signal. With kSpeed, InputError when the car goes backwards faster than 0.05 m/s in a valid
/// sample, because a replay only drives forward.
Recording ReplayInputs(const RecordedDrive& drive, ReplaySteering steering, ReplayDrive source);

}  // namespace trackbed
