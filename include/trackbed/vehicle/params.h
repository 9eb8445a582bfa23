#pragma once

#include <string>
#include <vector>

#include "trackbed/vehicle/steering_response.h"

namespace trackbed {

inline constexpr double kGravity = 9.81;  ///< Standard gravity, rounded [m/s^2].

enum class VehicleKind {
  kSteered,  ///< A car: two axles, steered front wheels.
  /// A vehicle that steers by different speeds of two driven wheels on one axle.
  kDifferential,
};

/// One axle of a vehicle with acceleration `a` on a flat road. A fixed fraction of the brake or
/// motor force acts on the axle. With m the vehicle's mass, the axle exerts the force m `force` a
/// on the road (corrected for the inertia of its wheels) and carries the load m (g `weight` +
/// `transfer` a). The axle slides when the force exceeds the friction mu times the load:
///   a > mu g weight/(force - mu transfer), or never if the denominator is not positive.
struct AxleGrip {
  double weight = 0.0;  ///< Fraction of the vehicle's weight that the axle carries at rest [1].
  double force = 0.0;   ///< Fraction of the vehicle's braking or driving force, >= 0 [1].
  /// Load transfer: +- height of the center of gravity over the wheelbase [1].
  double transfer = 0.0;
};

/// The limits of a vehicle's braking or acceleration, straight ahead on a flat road.
struct AccelerationLimit {
  double by_force = 0.0;        ///< Limit by the brakes or the motor [m/s^2].
  std::vector<AxleGrip> axles;  ///< Axles that must not slide.

  /// Returns the smaller of the limits by force and by friction [m/s^2], >= 0. The axle loads are
  /// those of a steady acceleration. After a sudden command, a body that overshoots in pitch
  /// temporarily unloads the rear axle further. In MuJoCo, no wheel of the Prius slides at the
  /// limit, and the rear wheels of the BMW do not slide up to 95 % of the limit. Gravity is 9.81
  /// m/s^2.
  [[nodiscard]] double At(double friction) const;
};

/// The parameters of a vehicle that planners and controllers use. The parameters are read from the
/// compiled MJCF (sim/car_model.h) and are not stored elsewhere. Tests may set them directly.
///
/// The vehicle frame V has its origin on the ground under the center of the rear axle, or of the
/// axle of the driven wheels. The axes of V are x forward, y left, z up.
///
/// Steering angles are those of the bicycle model's front wheel at the middle of the front axle.
/// With differential drive, the angle represents a ratio of wheel speeds. L is then the track b of
/// the driven wheels, so that kappa = tan(delta)/L means
///   tan(delta) = (v_R - v_L)/v,  v = (v_R + v_L)/2,
/// The vehicle is then a unicycle with the yaw rate (v_R - v_L)/b. All code that uses the bicycle
/// angle works for both kinds of vehicles.
struct VehicleParams {
  std::string name;
  VehicleKind kind = VehicleKind::kSteered;
  /// Wheelbase L [m]; with differential drive, the track b of the driven wheels.
  double wheelbase = 0.0;
  /// Distance l_g from the center of gravity to the rear axle, along x [m].
  double cg_to_rear = 0.0;
  double track_front = 0.0;   ///< Track of the front axle [m]; 0 with differential drive.
  double track_rear = 0.0;    ///< Track of the rear axle [m].
  double wheel_radius = 0.0;  ///< Radius of the wheels [m].
  double mass = 0.0;          ///< Mass [kg].
  /// Yaw inertia of the whole car about its center of gravity [kg m^2].
  double yaw_inertia = 0.0;
  /// Cornering stiffness of an axle at its static load, for both tyres together [N/rad]. The
  /// stiffness is 0 for a car without tyre coefficients.
  double cornering_stiffness_front = 0.0;
  double cornering_stiffness_rear = 0.0;
  double steering_limit = 0.0;  ///< Largest steering angle delta_max [rad].
  /// Largest rate omega_delta of delta, at the road wheels [rad/s].
  double steering_rate = 0.0;
  /// Lag tau of the road wheels behind an actuator that moves at a constant rate [s].
  double steering_lag = 0.0;
  SteeringResponse steering_response{};  ///< Response of the actuator to commands.
  /// Steering-wheel angle divided by road-wheel angle; 0: no steering wheel.
  double steering_ratio = 0.0;
  double length = 0.0;  ///< Length of the footprint [m].
  double width = 0.0;   ///< Width of the footprint [m].
  double height = 0.0;  ///< Height of the footprint [m].
  /// Distance from the rear axle to the rear end of the footprint [m].
  double rear_overhang = 0.0;

  // Limits straight ahead on a flat road with friction factor 1; 0 if unknown or unlimited.

  /// Friction mu: the largest force of a tyre divided by its load, as the minimum over all tyres at
  /// their static loads. A car with tyre coefficients has two tyre models, contacts and Magic
  /// Formula. Of the two friction values, the smaller one is used, because a plan must suit both
  /// tyre models.
  double friction_longitudinal = 0.0;  ///< Longitudinal friction [1].
  double friction_lateral = 0.0;       ///< Lateral friction [1].
  /// Limit of braking, without the help of drag and rolling resistance.
  AccelerationLimit braking;
  AccelerationLimit driving;  ///< Limit of driving from rest, minus the rolling resistance.
  /// Largest deceleration, braking.At(friction_longitudinal) [m/s^2].
  double max_deceleration = 0.0;
  /// Largest acceleration, driving.At(friction_longitudinal) [m/s^2].
  double max_acceleration = 0.0;
  /// The speed at which the motor's torque or power just balances drag and rolling resistance in
  /// still air [m/s]. With differential drive, the top speed is the maximum speed of the wheels
  /// minus a control margin for the servos.
  double top_speed = 0.0;

  /// Distance l_f from the center of gravity to the front axle, along x [m]. The distance is only
  /// defined for cars.
  [[nodiscard]] double cg_to_front() const { return wheelbase - cg_to_rear; }
  /// Delay of the road wheels behind a command that changes at a constant rate within the rate
  /// limit [s].
  [[nodiscard]] double steering_delay() const { return steering_lag + steering_response.delay(); }
  /// Smallest turning radius of the rear-axle center, at full lock [m].
  [[nodiscard]] double min_turning_radius() const;
};

/// Returns the largest deceleration [m/s^2] on a flat road with friction factor `road`; 0 if
/// unknown. For a vehicle with unknown axles, the result is max_deceleration times `road`, but at
/// most max_deceleration.
double MaxDeceleration(const VehicleParams& params, double road);

/// Returns the largest acceleration [m/s^2] on a flat road with friction factor `road`, computed in
/// the same way as MaxDeceleration.
double MaxAcceleration(const VehicleParams& params, double road);

/// The largest lateral acceleration [m/s^2], mu_y g times `road`; 0 if unknown.
double MaxLateralAcceleration(const VehicleParams& params, double road);

/// The steering angle [rad] with which the rear axle of a kinematic car follows `curvature` [1/m]:
/// delta = atan(L kappa).
double SteeringForCurvature(const VehicleParams& params, double curvature);

/// The curvature kappa = tan(delta)/L [1/m].
double CurvatureForSteering(const VehicleParams& params, double steering);

/// The angle [rad] at which the actuator comes to rest after a command from 0 to `command` [rad].
/// The angle is the value of the steering response's curve, reduced by half the backlash and
/// clamped to the steering limit.
double RestingSteering(const VehicleParams& params, double command);

/// Angles of the two front wheels [rad].
struct FrontAngles {
  double left = 0.0;
  double right = 0.0;
};

/// The Ackermann angles of the front wheels for a bicycle angle. Both wheels and the bicycle's
/// wheel turn about the same center on the rear axle's line (cot outer - cot inner = track/L).
FrontAngles AckermannAngles(const VehicleParams& params, double steering);

/// The derivatives of AckermannAngles with respect to the bicycle angle [1].
FrontAngles AckermannSlopes(const VehicleParams& params, double steering);

/// Returns the bicycle angle [rad] of two front wheels, the inverse of AckermannAngles: the mean of
/// the two bicycle angles that correspond to the left and the right wheel. The mean of bicycle
/// angles is well conditioned around zero, where the mean of cotangents would turn slight toe into
/// full lock.
double BicycleAngle(const VehicleParams& params, const FrontAngles& front);

/// Speeds of the two wheels of the rear axle, or of the wheels of a differential drive [m/s].
struct AxleSpeeds {
  double left = 0.0;
  double right = 0.0;
};

/// Returns the wheel speeds without slip, v_L = v - kappa v b/2 and v_R = v + kappa v b/2, with b
/// the track of the axle.
AxleSpeeds AxleSpeedsFor(const VehicleParams& params, double speed, double steering);

}  // namespace trackbed
