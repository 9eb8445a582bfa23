#pragma once

#include <string>

namespace trackbed {

/// What planners and controllers know of a steered car. Read from the compiled MJCF car
/// (sim/car_model.h), never written down a second time; tests may fill it by hand.
///
/// Vehicle frame V: origin on the ground under the rear-axle centre, x forward, y left, z up.
/// Steering angles are those of the bicycle model's front wheel at the middle of the front axle.
struct VehicleParams {
  std::string name;
  double wheelbase = 0.0;     ///< L [m]
  double cg_to_rear = 0.0;    ///< l_g: centre of gravity to rear axle, along x [m]
  double track_front = 0.0;   ///< [m]
  double track_rear = 0.0;    ///< [m]
  double wheel_radius = 0.0;  ///< [m]
  double mass = 0.0;          ///< [kg]
  double yaw_inertia = 0.0;   ///< of the whole car about its centre of gravity [kg m^2]
  /// Of an axle at its static load, both tyres together [N/rad]; 0 without tyre coefficients.
  double cornering_stiffness_front = 0.0;
  double cornering_stiffness_rear = 0.0;
  double steering_limit = 0.0;  ///< delta_max [rad]
  double steering_rate = 0.0;   ///< omega_delta at the road wheels [rad/s]
  double steering_lag = 0.0;    ///< tau: of the road wheels behind the actuator, on a ramp [s]
  double steering_ratio = 0.0;  ///< steering-wheel angle over road-wheel angle
  double length = 0.0;          ///< of the outline [m]
  double width = 0.0;           ///< of the outline [m]
  double height = 0.0;          ///< of the outline [m]
  double rear_overhang = 0.0;   ///< rear axle to the rear end of the outline [m]

  /// l_f: centre of gravity to front axle, along x [m].
  [[nodiscard]] double cg_to_front() const { return wheelbase - cg_to_rear; }
  /// Of the rear-axle centre at full lock [m].
  [[nodiscard]] double min_turning_radius() const;
};

/// The constant steering angle [rad] on which the rear axle of a kinematic car runs on `curvature`
/// [1/m]: delta = atan(L kappa).
double SteeringForCurvature(const VehicleParams& params, double curvature);

/// kappa = tan(delta)/L [1/m].
double CurvatureForSteering(const VehicleParams& params, double steering);

/// Angles of the two front wheels [rad].
struct FrontAngles {
  double left = 0.0;
  double right = 0.0;
};

/// The Ackermann angles of the front wheels for a bicycle angle: both wheels and the bicycle's
/// point at the same centre on the rear axle's line (cot outer - cot inner = track/L).
FrontAngles AckermannAngles(const VehicleParams& params, double steering);

/// The bicycle angle [rad] that two front wheels stand for: each wheel's own (the inverse of
/// AckermannAngles), averaged. Unlike the mean of cotangents it stays well conditioned around zero,
/// where a trace of toe would otherwise read as full lock.
double BicycleAngle(const VehicleParams& params, const FrontAngles& front);

}  // namespace trackbed
