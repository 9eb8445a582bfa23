#pragma once

#include <array>
#include <optional>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Speed below which a vehicle is considered at rest [m/s].
inline constexpr double kAtRestSpeed = 0.01;

/// Forces and slip of one wheel of a car with tyres. The tyre axes follow ISO 8855, with x along
/// the wheel's heading and y to the left.
struct WheelState {
  double normal_force = 0.0;        ///< Normal force on the tyre [N], >= 0.
  double longitudinal_force = 0.0;  ///< Force on the car along the tyre's x axis [N].
  double lateral_force = 0.0;       ///< Force on the car along the tyre's y axis [N].
  /// Angle from the tyre's x axis to the velocity of the contact point [rad], positive to the left.
  double slip_angle = 0.0;
  /// Slip ratio of the tyre, equal to (Omega R - v_x)/|v_x|; positive when driving.
  double slip_ratio = 0.0;
  /// Fraction of the friction ellipse that the force along the road uses, >= 0; 0 without load.
  /// The used fraction is hypot(F_x/(mu_x F_z), F_y/(mu_y F_z)), with the tyre's friction
  /// coefficients mu_x and mu_y on the road below it.
  double friction_use = 0.0;
};

/// The state of a car, reported by every plant. The axes of the car are x forward, y left and z up.
/// Yaw and steering angles are positive to the left. Roll is positive with the right side down, and
/// pitch is positive with the nose down. Speeds along x and y are measured in a frame on the ground
/// that turns with the car's yaw, but not with roll and pitch. Accelerations are along the axes of
/// the frame on the ground. Accelerations refer to the center of gravity at its height, and include
/// the effects of roll and pitch.
struct VehicleState {
  double time = 0.0;  ///< Time [s].
  /// Pose of the rear-axle center on the ground, in world coordinates; the yaw is not wrapped.
  Pose2 pose;
  double speed = 0.0;     ///< Speed of the rear-axle center along x [m/s], negative backwards.
  double distance = 0.0;  ///< Distance driven, equal to the integral of |speed| over time [m].
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
  double steering_actuator = 0.0;  ///< Steering angle of the rate-limited actuator [rad].
  /// Steering angle of the bicycle model [rad], measured at the front wheels, or from the speeds of
  /// the two driven wheels.
  double steering = 0.0;
  /// States of the wheels in the order front left, front right, rear left, rear right; nullopt for
  /// vehicle models without four tyres.
  std::optional<std::array<WheelState, 4>> wheels;
  double obstacle_force = 0.0;  ///< Sum of the normal forces between car and obstacles [N].
};

/// The command that a car executes during one control period.
struct Command {
  double steering = 0.0;      ///< Commanded steering angle of the bicycle model [rad].
  double acceleration = 0.0;  ///< Commanded rate of change of the speed along x, dv/dt [m/s^2].
  /// Gear of the car: with +1, the car never rolls backwards; with -1, the car never rolls
  /// forwards. A car that slows down comes to rest, and the brakes hold the car until the
  /// acceleration points along the gear again.
  int gear = 1;
  /// Whether the car coasts, with neither motor nor brakes in use. The acceleration of a coasting
  /// car results from drag, rolling resistance and slope, and the commanded `acceleration` is
  /// ignored. In plants without drag, rolling resistance and slope, a coasting car keeps its speed.
  bool coast = false;
};

}  // namespace trackbed
