#pragma once

#include <string>
#include <vector>

#include "trackbed/vehicle/steering_response.h"

namespace trackbed {

inline constexpr double kGravity = 9.81;  ///< Acceleration of gravity, rounded [m/s^2].

enum class VehicleKind {
  kSteered,  ///< A car with two axles and steered front wheels.
  /// A vehicle with differential drive, which steers by different speeds of two driven wheels on
  /// one axle.
  kDifferential,
};

/// The forces on one axle of a vehicle with the acceleration or deceleration `a` on a flat road. A
/// fixed fraction of the brake force or motor force acts on the axle. At the acceleration a, the
/// axle exerts the force m `force` a on the road (corrected for the inertia of its wheels), where m
/// is the vehicle's mass. At the acceleration a, the axle of a vehicle with the mass m carries the
/// load m (g `weight` + `transfer` a), with the weight fraction `weight` and the load transfer
/// factor `transfer`. The axle slides when its force exceeds the friction coefficient mu times its
/// load:
///   a > mu g weight/(force - mu transfer) in terms of AxleGrip's members, or never if the
///   denominator is not positive.
struct AxleGrip {
  double weight = 0.0;  ///< Fraction of the vehicle's weight that the axle carries at rest [1].
  /// Fraction of the vehicle's braking or driving force that acts on the axle, >= 0 [1].
  double force = 0.0;
  /// Load transfer factor: height of the center of gravity divided by the wheelbase; positive if
  /// the acceleration `a` increases the axle's load [1].
  double transfer = 0.0;
};

/// The limits on the braking or the acceleration of a vehicle that drives straight ahead on a flat
/// road.
struct AccelerationLimit {
  /// Maximum acceleration or deceleration that the motor or the brakes can produce [m/s^2].
  double by_force = 0.0;
  std::vector<AxleGrip> axles;  ///< Axles whose tyres must not slide.

  /// Returns the largest acceleration or deceleration that both the available force and the
  /// friction allow [m/s^2], >= 0. The friction limit is computed with the axle loads of a steady
  /// acceleration. After a sudden command, the body of the car may overshoot in pitch and
  /// temporarily unload the rear axle further. In MuJoCo, no wheel of the Prius slides at the
  /// computed friction limit. In MuJoCo, the rear wheels of the BMW do not slide up to 95 % of the
  /// computed friction limit. Gravity is assumed to be 9.81 m/s^2.
  [[nodiscard]] double At(double friction) const;
};

/// The parameters of a vehicle that planners and controllers use. The vehicle parameters are read
/// from the compiled MJCF (sim/car_model.h) and are not stored elsewhere. Tests may set the
/// parameters directly.
///
/// The vehicle frame V has its origin on the ground under the center of the rear axle; with
/// differential drive, under the center of the axle of the driven wheels. The axes of the vehicle
/// frame V are x forward, y left, z up.
///
/// Steering angles are angles of the front wheel of the bicycle model, which is at the middle of
/// the front axle. With differential drive, the steering angle delta represents a ratio of wheel
/// speeds. With differential drive, L is the track b of the driven wheels, so that kappa =
/// tan(delta)/L means
///   tan(delta) = (v_R - v_L)/v,  v = (v_R + v_L)/2.
/// A vehicle with differential drive moves as a unicycle with the yaw rate (v_R - v_L)/b, where v_R
/// and v_L are the wheel speeds and b is the track. All code that uses the steering angle of the
/// bicycle model works for cars and for vehicles with differential drive.
struct VehicleParams {
  std::string name;
  VehicleKind kind = VehicleKind::kSteered;
  /// Wheelbase L [m]; with differential drive, the track b of the driven wheels.
  double wheelbase = 0.0;
  /// Distance l_g from the center of gravity to the rear axle, along x [m].
  double cg_to_rear = 0.0;
  /// Track of the front axle [m]; 0 for a vehicle with differential drive.
  double track_front = 0.0;
  double track_rear = 0.0;    ///< Track of the rear axle [m].
  double wheel_radius = 0.0;  ///< Radius of the wheels [m].
  double mass = 0.0;          ///< Mass of the vehicle [kg].
  /// Yaw inertia of the whole car about its center of gravity [kg m^2].
  double yaw_inertia = 0.0;
  /// Cornering stiffness of an axle at its static load, for both tyres together [N/rad]. The
  /// cornering stiffness is 0 for a car without tyre coefficients.
  double cornering_stiffness_front = 0.0;
  double cornering_stiffness_rear = 0.0;
  double steering_limit = 0.0;  ///< Largest steering angle delta_max [rad].
  /// Largest rate omega_delta of the steering angle delta, at the road wheels [rad/s].
  double steering_rate = 0.0;
  /// Lag tau of the road wheels behind an actuator that moves at a constant rate [s].
  double steering_lag = 0.0;
  SteeringResponse steering_response{};  ///< Response of the steering actuator to commands.
  /// Steering-wheel angle divided by road-wheel angle; 0: no steering wheel.
  double steering_ratio = 0.0;
  double length = 0.0;  ///< Length of the vehicle's footprint [m].
  double width = 0.0;   ///< Width of the vehicle's footprint [m].
  double height = 0.0;  ///< Height of the vehicle [m].
  /// Distance from the rear axle to the rear end of the footprint [m].
  double rear_overhang = 0.0;

  // The limits of friction, acceleration and speed below are for driving straight ahead on a flat
  // road with the friction factor 1. A limit of 0 means that the limit is unknown, or that the
  // vehicle has no such limit.

  /// Friction coefficient mu: the largest force of a tyre divided by its load. The friction
  /// coefficient is the minimum over all tyres at their static loads. A car with tyre coefficients
  /// has two tyre models, contacts and Magic Formula. The smaller friction coefficient of the two
  /// tyre models is used, because a plan must suit both tyre models.
  double friction_longitudinal = 0.0;  ///< Longitudinal friction coefficient mu_x [1].
  double friction_lateral = 0.0;       ///< Lateral friction coefficient mu_y [1].
  /// Limit of the car's deceleration by braking, without the help of drag and rolling resistance.
  AccelerationLimit braking;
  /// Limit of the car's acceleration from rest, reduced by the rolling resistance.
  AccelerationLimit driving;
  /// Maximum deceleration of the vehicle [m/s^2], equal to braking.At(friction_longitudinal).
  double max_deceleration = 0.0;
  /// Maximum acceleration of the vehicle [m/s^2], equal to driving.At(friction_longitudinal).
  double max_acceleration = 0.0;
  /// Top speed [m/s], at which the motor's torque or power just balances drag and rolling
  /// resistance in still air. With differential drive, the top speed is the maximum speed of the
  /// wheels minus a control margin for the servos.
  double top_speed = 0.0;

  /// Distance l_f from the center of gravity to the front axle, along x [m]. The distance l_f is
  /// only defined for cars.
  [[nodiscard]] double cg_to_front() const { return wheelbase - cg_to_rear; }
  /// Delay [s] of the road wheels behind a command that changes at a constant rate within the rate
  /// limit.
  [[nodiscard]] double steering_delay() const { return steering_lag + steering_response.delay(); }
  /// Smallest turning radius of the rear-axle center, at full lock [m].
  [[nodiscard]] double min_turning_radius() const;
};

/// Returns the vehicle's maximum deceleration [m/s^2] on a flat road with the friction factor
/// `road`; 0 if unknown. For a vehicle with unknown axles, the returned deceleration is
/// max_deceleration times `road`, but at most max_deceleration.
double MaxDeceleration(const VehicleParams& params, double road);

/// Returns the vehicle's maximum acceleration [m/s^2] on a flat road with the friction factor
/// `road`, computed in the same way as in MaxDeceleration.
double MaxAcceleration(const VehicleParams& params, double road);

/// Returns the vehicle's maximum lateral acceleration [m/s^2] on a road with the friction factor
/// `road`, equal to mu_y g `road`; 0 if unknown.
double MaxLateralAcceleration(const VehicleParams& params, double road);

/// Returns the steering angle [rad] with which the rear axle of a kinematic car follows a path of
/// the curvature kappa = `curvature` [1/m]: delta = atan(L kappa).
double SteeringForCurvature(const VehicleParams& params, double curvature);

/// Returns the path curvature kappa = tan(delta)/L [1/m] of a kinematic car's rear axle.
double CurvatureForSteering(const VehicleParams& params, double steering);

/// Returns the angle [rad] at which the actuator comes to rest after the command changes from 0 to
/// `command` [rad]. The angle at rest is the value of the steering response's curve, reduced by
/// half the backlash and clamped to the steering limit.
double RestingSteering(const VehicleParams& params, double command);

/// Steering angles of the two front wheels [rad].
struct FrontAngles {
  double left = 0.0;
  double right = 0.0;
};

/// Returns the Ackermann angles of the front wheels for a steering angle of the bicycle model. Both
/// front wheels and the single front wheel of the bicycle model turn about the same center on the
/// line of the rear axle (cot outer - cot inner = track/L).
FrontAngles AckermannAngles(const VehicleParams& params, double steering);

/// Returns the derivatives of the AckermannAngles with respect to the bicycle model's steering
/// angle [1].
FrontAngles AckermannSlopes(const VehicleParams& params, double steering);

/// Returns the steering angle of the bicycle model [rad] for given angles of the two front wheels;
/// the inverse of AckermannAngles. The returned angle is the mean of the two bicycle angles that
/// correspond to the left and to the right wheel. The mean of bicycle angles is well conditioned
/// around zero, where a mean of cotangents would convert a slight toe angle to full lock.
double BicycleAngle(const VehicleParams& params, const FrontAngles& front);

/// Speeds of the two wheels of the rear axle, or of the two driven wheels of a differential drive
/// [m/s].
struct AxleSpeeds {
  double left = 0.0;
  double right = 0.0;
};

/// Returns the speeds of the wheels if they do not slip: v_L = v - kappa v b/2 and v_R = v + kappa
/// v b/2, with the speed v, the path curvature kappa, and the track b of the axle.
AxleSpeeds AxleSpeedsFor(const VehicleParams& params, double speed, double steering);

}  // namespace trackbed
