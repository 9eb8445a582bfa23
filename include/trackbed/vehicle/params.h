#pragma once

#include <string>
#include <vector>

#include "trackbed/vehicle/steering_response.h"

namespace trackbed {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]

enum class VehicleKind {
  kSteered,       ///< a car: two axles, steered front wheels
  kDifferential,  ///< turns by the speeds of its two driven wheels, which share one axle
};

/// One axle of a vehicle that changes its speed by `a` on a flat road. Brakes and motor push it
/// with a fixed share, so that it puts m force a on the road (its wheels' own inertia is off),
/// under a load of m (g weight + transfer a), m being the vehicle's mass. It slides where that is
/// more than the friction mu times that:
///   a > mu g weight/(force - mu transfer), or never where the denominator is not above 0.
struct AxleGrip {
  double weight = 0.0;    ///< share of the weight at rest [1]
  double force = 0.0;     ///< >= 0 [1]
  double transfer = 0.0;  ///< of load; +- height of the center of gravity over the wheelbase [1]
};

/// How hard a vehicle can brake, or accelerate, straight ahead on a flat road.
struct AccelerationLimit {
  double by_force = 0.0;        ///< of the brakes or the motor [m/s^2]
  std::vector<AxleGrip> axles;  ///< that have to hold

  /// The smaller of both [m/s^2], >= 0. The loads are those of an acceleration which lasts: asked
  /// for at once, a body that pitches beyond that unloads the rear axle more at first. (MuJoCo: the
  /// Prius' wheels all hold, the BMW's rear ones up to 95 % of its limit.) Gravity is 9.81 m/s^2.
  [[nodiscard]] double At(double friction) const;
};

/// What planners and controllers know of a vehicle. Read from its compiled MJCF (sim/car_model.h),
/// not stored elsewhere; tests may fill it by hand.
///
/// Vehicle frame V: origin on the ground under the center of the rear axle, or of the axle of the
/// driven wheels; x forward, y left, z up.
///
/// Steering angles are those of the bicycle model's front wheel at the middle of the front axle.
/// With differential drive that wheel represents a ratio of wheel speeds. Its L is the track b of
/// the driven wheels, so that kappa = tan(delta)/L says
///   tan(delta) = (v_R - v_L)/v,  v = (v_R + v_L)/2,
/// a unicycle with yaw rate (v_R - v_L)/b. All code that uses the bicycle angle works for both.
struct VehicleParams {
  std::string name;
  VehicleKind kind = VehicleKind::kSteered;
  double wheelbase = 0.0;     ///< L [m]; b with differential drive
  double cg_to_rear = 0.0;    ///< l_g: center of gravity to rear axle, along x [m]
  double track_front = 0.0;   ///< [m]; 0 with differential drive
  double track_rear = 0.0;    ///< [m]
  double wheel_radius = 0.0;  ///< [m]
  double mass = 0.0;          ///< [kg]
  double yaw_inertia = 0.0;   ///< of the whole car about its center of gravity [kg m^2]
  /// Of an axle at its static load, both tyres together [N/rad]; 0 without tyre coefficients.
  double cornering_stiffness_front = 0.0;
  double cornering_stiffness_rear = 0.0;
  double steering_limit = 0.0;  ///< delta_max [rad]
  double steering_rate = 0.0;   ///< omega_delta at the road wheels, of delta anyway [rad/s]
  double steering_lag = 0.0;    ///< tau: of the road wheels behind the actuator, on a ramp [s]
  SteeringResponse steering_response{};  ///< of the actuator to commands
  double steering_ratio =
      0.0;                     ///< steering-wheel angle over road-wheel angle; 0: no steering wheel
  double length = 0.0;         ///< of the footprint [m]
  double width = 0.0;          ///< of the footprint [m]
  double height = 0.0;         ///< of the footprint [m]
  double rear_overhang = 0.0;  ///< rear axle to the rear end of the footprint [m]

  // Limits straight ahead on a flat road of factor 1; 0: not known, and nothing is limited by it.

  /// mu: the largest force of a tyre over its load, the minimum over all tyres at their static
  /// loads. For a car with tyre coefficients, the smaller value of the two tyre models, contacts
  /// and Magic Formula, because a plan must suit both.
  double friction_longitudinal = 0.0;  ///< [1]
  double friction_lateral = 0.0;       ///< [1]
  AccelerationLimit braking;           ///< drag and rolling resistance, which help, are left out
  AccelerationLimit driving;           ///< from rest, less the rolling resistance
  double max_deceleration = 0.0;       ///< braking.At(friction_longitudinal) [m/s^2]
  double max_acceleration = 0.0;       ///< driving.At(friction_longitudinal) [m/s^2]
  /// Where torque or power equal drag and rolling resistance in still air [m/s]; with differential
  /// drive, that of both wheels at the largest speed with a control margin for their servos.
  double top_speed = 0.0;

  /// l_f: center of gravity to front axle, along x [m]. Of cars only.
  [[nodiscard]] double cg_to_front() const { return wheelbase - cg_to_rear; }
  /// Of the road wheels behind the command, on a ramp within the rate limit [s].
  [[nodiscard]] double steering_delay() const { return steering_lag + steering_response.delay(); }
  /// Of the rear-axle center at full lock [m].
  [[nodiscard]] double min_turning_radius() const;
};

/// The largest deceleration [m/s^2] on a flat road of factor `road`; 0: not known. Of parameters
/// that have no axles, at most the road's share of max_deceleration.
double MaxDeceleration(const VehicleParams& params, double road);

/// Likewise the largest acceleration.
double MaxAcceleration(const VehicleParams& params, double road);

/// Likewise the largest lateral acceleration, mu_y g times `road`.
double MaxLateralAcceleration(const VehicleParams& params, double road);

/// The steering angle [rad] with which the rear axle of a kinematic car follows `curvature` [1/m]:
/// delta = atan(L kappa).
double SteeringForCurvature(const VehicleParams& params, double curvature);

/// kappa = tan(delta)/L [1/m].
double CurvatureForSteering(const VehicleParams& params, double steering);

/// The angle [rad] at which the actuator comes to rest when it is steered to `command` [rad] from
/// the command 0: the curve of the steering response less half the backlash, within the limit.
double RestingSteering(const VehicleParams& params, double command);

/// Angles of the two front wheels [rad].
struct FrontAngles {
  double left = 0.0;
  double right = 0.0;
};

/// The Ackermann angles of the front wheels for a bicycle angle: both wheels and the bicycle's
/// point at the same center on the rear axle's line (cot outer - cot inner = track/L).
FrontAngles AckermannAngles(const VehicleParams& params, double steering);

/// How fast they turn with the bicycle angle: the derivatives of AckermannAngles [1].
FrontAngles AckermannSlopes(const VehicleParams& params, double steering);

/// The bicycle angle [rad] that two front wheels stand for: each wheel's own (the inverse of
/// AckermannAngles), averaged. Unlike the mean of cotangents it stays well conditioned around zero,
/// where the mean of cotangents would turn slight toe into full lock.
double BicycleAngle(const VehicleParams& params, const FrontAngles& front);

/// Speeds of the two wheels of the rear axle, or of those that a differential drive has [m/s].
struct AxleSpeeds {
  double left = 0.0;
  double right = 0.0;
};

/// v_L, v_R = v -+ kappa v b/2, without slip, b the track of that axle.
AxleSpeeds AxleSpeedsFor(const VehicleParams& params, double speed, double steering);

}  // namespace trackbed
