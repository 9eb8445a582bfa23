#pragma once

#include <string>
#include <vector>

#include "trackbed/vehicle/steering_response.h"

namespace trackbed {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]

enum class VehicleKind {
  kSteered,       ///< a car: two axles, steered front wheels
  kDifferential,  ///< steers by the speeds of its two driven wheels, on one axle
};

/// One axle of a vehicle with acceleration `a` on a flat road. Brakes and motor act on it with a
/// fixed fraction, so that it exerts m force a on the road (corrected for its wheels' inertia),
/// under a load of m (g weight + transfer a), with m the vehicle's mass. It slides when that
/// exceeds the friction mu times the load:
///   a > mu g weight/(force - mu transfer), or never if the denominator is not positive.
struct AxleGrip {
  double weight = 0.0;    ///< fraction of the weight at rest [1]
  double force = 0.0;     ///< >= 0 [1]
  double transfer = 0.0;  ///< of load; +- height of the center of gravity over the wheelbase [1]
};

/// The limits of a vehicle's braking or acceleration, straight ahead on a flat road.
struct AccelerationLimit {
  double by_force = 0.0;        ///< of the brakes or the motor [m/s^2]
  std::vector<AxleGrip> axles;  ///< the axles that must not slide

  /// The smaller limit [m/s^2], >= 0. Loads are those of a lasting acceleration: after a sudden
  /// command, a body that overshoots in pitch temporarily unloads the rear axle further. (MuJoCo:
  /// none of the Prius' wheels slide, and the BMW's rear wheels do not slide up to 95 % of its
  /// limit.) Gravity is 9.81 m/s^2.
  [[nodiscard]] double At(double friction) const;
};

/// The parameters of a vehicle that planners and controllers use. Read from its compiled MJCF
/// (sim/car_model.h), not stored elsewhere; tests may set them directly.
///
/// Vehicle frame V: origin on the ground under the center of the rear axle, or of the axle of the
/// driven wheels; x forward, y left, z up.
///
/// Steering angles are those of the bicycle model's front wheel at the middle of the front axle.
/// With differential drive that wheel represents a ratio of wheel speeds. Its L is the track b of
/// the driven wheels, so that kappa = tan(delta)/L means
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
  /// Of an axle at its static load, for both tyres together [N/rad]; 0 without tyre coefficients.
  double cornering_stiffness_front = 0.0;
  double cornering_stiffness_rear = 0.0;
  double steering_limit = 0.0;  ///< delta_max [rad]
  /// omega_delta: largest rate of delta, at the road wheels [rad/s].
  double steering_rate = 0.0;
  double steering_lag = 0.0;  ///< tau: lag of the road wheels behind the actuator, on a ramp [s]
  SteeringResponse steering_response{};  ///< of the actuator to commands
  double steering_ratio =
      0.0;                     ///< steering-wheel angle over road-wheel angle; 0: no steering wheel
  double length = 0.0;         ///< of the footprint [m]
  double width = 0.0;          ///< of the footprint [m]
  double height = 0.0;         ///< of the footprint [m]
  double rear_overhang = 0.0;  ///< rear axle to the rear end of the footprint [m]

  // Limits straight ahead on a flat road of factor 1; 0: unknown, no limit.

  /// mu: the largest force of a tyre over its load, the minimum over all tyres at their static
  /// loads. For a car with tyre coefficients, the smaller value of the two tyre models, contacts
  /// and Magic Formula, because a plan must suit both.
  double friction_longitudinal = 0.0;  ///< [1]
  double friction_lateral = 0.0;       ///< [1]
  AccelerationLimit braking;           ///< without drag and rolling resistance, which would help
  AccelerationLimit driving;           ///< from rest, minus the rolling resistance
  double max_deceleration = 0.0;       ///< braking.At(friction_longitudinal) [m/s^2]
  double max_acceleration = 0.0;       ///< driving.At(friction_longitudinal) [m/s^2]
  /// The speed at which torque or power equal drag and rolling resistance in still air [m/s]; with
  /// differential drive, that of both wheels at their largest speed, minus a control margin for the
  /// servos.
  double top_speed = 0.0;

  /// l_f: center of gravity to front axle, along x [m]. Only for cars.
  [[nodiscard]] double cg_to_front() const { return wheelbase - cg_to_rear; }
  /// Delay of the road wheels behind the command, on a ramp within the rate limit [s].
  [[nodiscard]] double steering_delay() const { return steering_lag + steering_response.delay(); }
  /// Smallest turning radius of the rear-axle center, at full lock [m].
  [[nodiscard]] double min_turning_radius() const;
};

/// The largest deceleration [m/s^2] on a flat road of factor `road`; 0: unknown. For parameters
/// without axles, at most max_deceleration times `road`.
double MaxDeceleration(const VehicleParams& params, double road);

/// The largest acceleration [m/s^2], as MaxDeceleration.
double MaxAcceleration(const VehicleParams& params, double road);

/// The largest lateral acceleration [m/s^2], mu_y g times `road`; 0: unknown.
double MaxLateralAcceleration(const VehicleParams& params, double road);

/// The steering angle [rad] with which the rear axle of a kinematic car follows `curvature` [1/m]:
/// delta = atan(L kappa).
double SteeringForCurvature(const VehicleParams& params, double curvature);

/// kappa = tan(delta)/L [1/m].
double CurvatureForSteering(const VehicleParams& params, double steering);

/// The angle [rad] at which the actuator comes to rest when it is commanded from 0 to `command`
/// [rad]: the curve of the steering response minus half the backlash, within the limit.
double RestingSteering(const VehicleParams& params, double command);

/// Angles of the two front wheels [rad].
struct FrontAngles {
  double left = 0.0;
  double right = 0.0;
};

/// The Ackermann angles of the front wheels for a bicycle angle: both wheels and the bicycle's
/// point at the same center on the rear axle's line (cot outer - cot inner = track/L).
FrontAngles AckermannAngles(const VehicleParams& params, double steering);

/// The derivatives of AckermannAngles with respect to the bicycle angle [1].
FrontAngles AckermannSlopes(const VehicleParams& params, double steering);

/// The bicycle angle [rad] of two front wheels: the mean of the bicycle angles of each wheel (the
/// inverse of AckermannAngles). Unlike the mean of cotangents, it is well conditioned around zero,
/// where the mean of cotangents would turn slight toe into full lock.
double BicycleAngle(const VehicleParams& params, const FrontAngles& front);

/// Speeds of the two wheels of the rear axle, or of a differential drive's wheels [m/s].
struct AxleSpeeds {
  double left = 0.0;
  double right = 0.0;
};

/// v_L, v_R = v -+ kappa v b/2, without slip, with b the track of that axle.
AxleSpeeds AxleSpeedsFor(const VehicleParams& params, double speed, double steering);

}  // namespace trackbed
