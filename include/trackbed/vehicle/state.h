#pragma once

#include <array>
#include <optional>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Speed below which a vehicle is considered at rest [m/s].
inline constexpr double kAtRestSpeed = 0.01;

/// One wheel of a car with tyres. Tyre axes as in ISO 8855: x along the wheel's heading, y to its
/// left.
struct WheelState {
  double normal_force = 0.0;        ///< [N], >= 0
  double longitudinal_force = 0.0;  ///< on the car, along tyre x [N]
  double lateral_force = 0.0;       ///< on the car, along tyre y [N]
  double slip_angle =
      0.0;  ///< from tyre x to the velocity of the contact point [rad], left positive
  double slip_ratio = 0.0;  ///< (Omega R - v_x)/|v_x|, driving positive
};

/// The state of a car, reported by every plant. Axes x forward, y left, z up; angles positive to
/// the left (roll: right side down; pitch: nose down). Speeds along x and y are those of points on
/// the ground that turn with the car's yaw. Accelerations are those of the center of gravity, at
/// its height, along the same axes, and include the effects of roll and pitch.
struct VehicleState {
  double time = 0.0;           ///< [s]
  Pose2 pose;                  ///< rear-axle center on the ground, in the world; yaw is not wrapped
  double speed = 0.0;          ///< of the rear-axle center along x [m/s], negative backwards
  double distance = 0.0;       ///< odometer: integral of |speed| [m]
  double lateral_speed = 0.0;  ///< below the center of gravity, along y [m/s]
  double yaw_rate = 0.0;       ///< [rad/s]
  double roll = 0.0;           ///< [rad]
  double pitch = 0.0;          ///< [rad]
  double longitudinal_acceleration = 0.0;  ///< of the center of gravity, free of gravity [m/s^2]
  double lateral_acceleration = 0.0;       ///< of the center of gravity, free of gravity [m/s^2]
  double sideslip = 0.0;                   ///< at the center of gravity [rad]
  double steering_actuator = 0.0;          ///< angle of the rate-limited actuator [rad]
  /// Bicycle angle measured at the front wheels, or from the speeds of two driven wheels [rad].
  double steering = 0.0;
  std::optional<std::array<WheelState, 4>> wheels;  ///< fl, fr, rl, rr; none without four tyres
  double obstacle_force = 0.0;  ///< sum of the normal forces between car and obstacles [N]
};

/// The command to a car for one control period.
struct Command {
  double steering = 0.0;      ///< commanded bicycle angle [rad]
  double acceleration = 0.0;  ///< commanded dv/dt along x [m/s^2]
  int gear =
      1;  ///< +1: never rolls backwards, -1: never forwards. Slowing down ends in standstill,
          ///< held by the brakes until the acceleration points along the gear again
  /// Coasts, without motor and brakes: drag, rolling resistance and slope determine the
  /// acceleration, and `acceleration` is ignored. Plants without such forces keep their speed.
  bool coast = false;
};

}  // namespace trackbed
