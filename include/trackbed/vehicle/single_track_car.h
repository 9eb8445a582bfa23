#pragma once

#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

/// The linear dynamic single-track car (Riekert and Schunck 1940; Mitschke and Wallentowitz 2014)
/// behind a rate-limited steering actuator, with prescribed speed.
///
/// Symbols (ISO 8855): u speed along the car's x axis [m/s], signed; v lateral speed at the center
/// of gravity [m/s]; r yaw rate [rad/s]; delta steering; m mass; I yaw inertia; l_f, l_r center of
/// gravity to the axles; L = l_f + l_r; C_f, C_r the axles' cornering stiffness [N/rad]; F_f, F_r
/// their lateral forces [N], left positive.
///   m (v' + u r) = F_f + F_r         F_f = C_f (u tan(delta) - v - l_f r)/|u|
///   I r' = l_f F_f - l_r F_r         F_r = -C_r (v - l_r r)/|u|
/// Slip angles are assumed to be small: tan(alpha) is replaced by alpha, and the front force F_f
/// acts entirely along y. The steering angle need not be small: with tan(delta), a car without slip
/// is the kinematic car. The forces oppose the axles' lateral motion, whether the car rolls
/// forwards or backwards.
///
/// Steady state: r = u tan(delta)/(L + K u |u|) with K = m (l_r/C_f - l_f/C_r)/L [s^2/m]. Like the
/// linear car, this car is unstable above the speed sqrt(L/|K|), for K < 0 when driving forwards,
/// and for K > 0 when driving backwards.
namespace trackbed {

struct SingleTrackState {
  Pose2 pose;                  ///< Pose of the rear axle.
  double speed = 0.0;          ///< Speed u [m/s].
  double lateral_speed = 0.0;  ///< Lateral speed v [m/s]; 0 at rest.
  double yaw_rate = 0.0;       ///< Yaw rate r [rad/s]; 0 at rest.
  double steering = 0.0;       ///< Angle delta of the actuator [rad].
  double distance = 0.0;       ///< Driven distance, the integral of |u| [m].
};

/// Returns the state of a car that rolls without slip. The argument `state` is that of a
/// KinematicCar with the rear axle as its reference point.
SingleTrackState RollingWithoutSlip(const VehicleParams& params, const KinematicState& state);

/// A single-track car with prescribed speed. Guarantees: steering and speed are exactly those of
/// KinematicCar, including its rules of standstill and gears. The ratios v/u and r/u are integrated
/// by Radau IIA of fifth order, over at most 2 ms at a time. When the speed u passes through zero,
/// v and r decay infinitely fast, but the ratios v/u and r/u have a finite limit. Therefore the
/// model needs no blending or switching at low speed, and a slow car equals the kinematic car
/// except for terms of O(u^2) and O(u'). A step is split when the steering reaches its target and
/// when the car comes to rest. The step size changes the result by less than 1e-9 m and rad over
/// seconds of driving. Braking harder than tyres allow (some 50 m/s^2) is outside the model. The
/// model has linear tyres without a friction limit, and no wheel loads, roll, wind or grades.
///
/// InternalError unless mass, yaw inertia and both cornering stiffnesses are above zero. Cost:
/// about 2 us per 2 ms.
class SingleTrackCar {
 public:
  SingleTrackCar(const VehicleParams& params, const SingleTrackState& start);

  /// Advances by `duration` [s] >= 0 under a constant command. PreconditionError unless all
  /// arguments are finite.
  void Step(const Command& command, double duration);

  /// Displaces the car instantaneously by `left` [m] to its left.
  void ApplyLateralOffset(double left);

  /// Applies an impulse to the left [N s] at the center of gravity. The impulse has no effect on a
  /// car at rest, which has no lateral speed.
  void ApplyLateralForce(double impulse);

  [[nodiscard]] const SingleTrackState& state() const { return state_; }

  /// Returns the full state. Accelerations are those at the end of the last step, and `time` is the
  /// total duration of the steps. The state has no wheel forces, because the model only has axle
  /// forces.
  [[nodiscard]] VehicleState FullState() const;

 private:
  /// The ratios v/u [rad] and r/u [1/m].
  using Ratios = Vec2;
  [[nodiscard]] Eigen::Matrix2d Decay(double speed, double acceleration_along) const;
  [[nodiscard]] Ratios RatiosAt(double direction, double acceleration) const;
  void Advance(const MotionPiece& piece);
  void StepByRadau(const MotionPiece& piece);

  VehicleParams params_;
  SingleTrackState state_;
  Eigen::Matrix2d slip_rate_;  // Decay of v and r by the tyres, per unit of 1/|u| [m/s^2].
  Vec2 steer_gain_;            // Gain of v and r, per unit of tan(delta).
  double time_ = 0.0;
  double acceleration_ = 0.0;  // Acceleration at the end of the last step [m/s^2].
};

}  // namespace trackbed
