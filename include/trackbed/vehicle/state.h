#pragma once

#include <array>
#include <optional>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Speed below which a vehicle is considered at rest [m/s].
inline constexpr double kAtRestSpeed = 0.01;

/// One wheel of a car with tyres. The tyre axes are those of ISO 8855: x along the wheel's heading,
/// y to its left.
struct WheelState {
  double normal_force = 0.0;        ///< Normal force [N], >= 0.
  double longitudinal_force = 0.0;  ///< Force on the car along the tyre's x axis [N].
  double lateral_force = 0.0;       ///< Force on the car along the tyre's y axis [N].
  /// Angle from the tyre's x axis to the velocity of the contact point [rad], positive to the left.
  double slip_angle = 0.0;
  double slip_ratio = 0.0;  ///< Slip ratio (Omega R - v_x)/|v_x|, positive when driving.
};

/// The state of a car, reported by every plant. The axes are x forward, y left, z up. Angles are
/// positive to the left; roll is positive with the right side down, pitch with the nose down.
/// Speeds along x and y are those of points of a frame on the ground that turns with the car's yaw,
/// but not with roll and pitch. Accelerations are those of the center of gravity, at its height,
/// along the same axes, and include the effects of roll and pitch.
struct VehicleState {
  double time = 0.0;  ///< Time [s].
  /// Pose of the rear-axle center on the ground, in the world; the yaw is not wrapped.
  Pose2 pose;
  double speed = 0.0;     ///< Speed of the rear-axle center along x [m/s], negative backwards.
  double distance = 0.0;  ///< Odometer, the integral of |speed| [m].
  /// Speed along y of the ground point below the center of gravity [m/s].
  double lateral_speed = 0.0;
  double yaw_rate = 0.0;  ///< Yaw rate [rad/s].
  double roll = 0.0;      ///< Roll angle [rad].
  double pitch = 0.0;     ///< Pitch angle [rad].
  /// Acceleration of the center of gravity along x, without gravity [m/s^2].
  double longitudinal_acceleration = 0.0;
  /// Acceleration of the center of gravity along y, without gravity [m/s^2].
  double lateral_acceleration = 0.0;
  double sideslip = 0.0;           ///< Sideslip angle at the center of gravity [rad].
  double steering_actuator = 0.0;  ///< Angle of the rate-limited actuator [rad].
  /// Bicycle angle measured at the front wheels, or from the speeds of two driven wheels [rad].
  double steering = 0.0;
  /// Wheels in the order front left, front right, rear left, rear right; nullopt for models without
  /// four tyres.
  std::optional<std::array<WheelState, 4>> wheels;
  double obstacle_force = 0.0;  ///< Sum of the normal forces between car and obstacles [N].
};

/// The command to a car for one control period.
struct Command {
  double steering = 0.0;      ///< Commanded angle of the bicycle model [rad].
  double acceleration = 0.0;  ///< Commanded rate of the speed, dv/dt along x [m/s^2].
  /// Gear: with +1 the car never rolls backwards, with -1 never forwards. A car that slows down
  /// comes to rest, and the brakes hold the car until the acceleration points along the gear again.
  int gear = 1;
  /// Whether the car coasts, without motor and brakes. Drag, rolling resistance and slope then
  /// determine the acceleration, and `acceleration` is ignored. Plants without drag, rolling
  /// resistance and slope keep their speed.
  bool coast = false;
};

}  // namespace trackbed
