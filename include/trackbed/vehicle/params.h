#pragma once

#include <string>

namespace trackbed {

enum class VehicleKind {
  kSteered,       ///< a car: two axles, steered front wheels
  kDifferential,  ///< turns by the speeds of its two driven wheels, which share one axle
};

/// What planners and controllers know of a vehicle. Read from its compiled MJCF
/// (sim/car_model.h), never written down a second time; tests may fill it by hand.
///
/// Vehicle frame V: origin on the ground under the centre of the rear axle, or of the axle of the
/// driven wheels; x forward, y left, z up.
///
/// Steering angles are those of the bicycle model's front wheel at the middle of the front axle.
/// With differential drive that wheel is a name for a ratio of speeds. Its L is the track b of the
/// driven wheels, so that kappa = tan(delta)/L says
///   tan(delta) = (v_R - v_L)/v,  v = (v_R + v_L)/2,
/// a unicycle with yaw rate (v_R - v_L)/b. Everything that reckons with a bicycle angle drives
/// both.
struct VehicleParams {
  std::string name;
  VehicleKind kind = VehicleKind::kSteered;
  double wheelbase = 0.0;     ///< L [m]; b with differential drive
  double cg_to_rear = 0.0;    ///< l_g: centre of gravity to rear axle, along x [m]
  double track_front = 0.0;   ///< [m]; 0 with differential drive
  double track_rear = 0.0;    ///< [m]
  double wheel_radius = 0.0;  ///< [m]
  double mass = 0.0;          ///< [kg]
  double yaw_inertia = 0.0;   ///< of the whole car about its centre of gravity [kg m^2]
  /// Of an axle at its static load, both tyres together [N/rad]; 0 without tyre coefficients.
  double cornering_stiffness_front = 0.0;
  double cornering_stiffness_rear = 0.0;
  double steering_limit = 0.0;  ///< delta_max [rad]
  double steering_rate = 0.0;   ///< omega_delta at the road wheels, of delta anyway [rad/s]
  double steering_lag = 0.0;    ///< tau: of the road wheels behind the actuator, on a ramp [s]
  double steering_ratio = 0.0;  ///< steering-wheel angle over road-wheel angle; 0: no such wheel
  double length = 0.0;          ///< of the outline [m]
  double width = 0.0;           ///< of the outline [m]
  double height = 0.0;          ///< of the outline [m]
  double rear_overhang = 0.0;   ///< rear axle to the rear end of the outline [m]

  /// l_f: centre of gravity to front axle, along x [m]. Of cars only.
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

/// Speeds of the two wheels of the rear axle, or of those that a differential drive has [m/s].
struct AxleSpeeds {
  double left = 0.0;
  double right = 0.0;
};

/// v_L, v_R = v -+ kappa v b/2, without slip, b the track of that axle.
AxleSpeeds AxleSpeedsFor(const VehicleParams& params, double speed, double steering);

}  // namespace trackbed
