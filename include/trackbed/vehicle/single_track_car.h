#pragma once

#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

/// The linear dynamic single-track car (Riekert and Schunck 1940; Mitschke and Wallentowitz 2014)
/// behind a rate-limited steering actuator, with prescribed speed.
///
/// Symbols (ISO 8855): u speed along the car's x axis [m/s], signed; v lateral speed at the center
/// of gravity [m/s]; r yaw rate [rad/s]; delta steering angle; m mass; I yaw inertia; l_f, l_r
/// distances from the center of gravity to the axles; L = l_f + l_r; C_f, C_r cornering stiffnesses
/// of the axles [N/rad]; F_f, F_r lateral forces of the axles [N], positive to the left. The
/// equations of motion are:
///   m (v' + u r) = F_f + F_r         F_f = C_f (u tan(delta) - v - l_f r)/|u|
///   I r' = l_f F_f - l_r F_r         F_r = -C_r (v - l_r r)/|u|.
/// Slip angles are assumed to be small: tan(alpha) is replaced by alpha, and the front force F_f
/// acts entirely along y. Because the equations contain tan(delta), the steering angle need not be
/// small, and a car without slip moves as the kinematic car. The lateral forces oppose the lateral
/// motion of the axles, whether the car rolls forwards or backwards.
///
/// In the steady state, the yaw rate is r = u tan(delta)/(L + K u |u|) with K = m (l_r/C_f -
/// l_f/C_r)/L [s^2/m]. Above the speed sqrt(L/|K|), with the understeer gradient K and the
/// wheelbase L, the car is unstable when driving forwards if K < 0, and when driving backwards if K
/// > 0.
namespace trackbed {

struct SingleTrackState {
  Pose2 pose;                  ///< Pose of the rear-axle center.
  double speed = 0.0;          ///< Speed u [m/s].
  double lateral_speed = 0.0;  ///< Lateral speed v at the center of gravity [m/s]; 0 at rest.
  double yaw_rate = 0.0;       ///< Yaw rate r of the car [rad/s]; 0 at rest.
  double steering = 0.0;       ///< Steering angle delta of the actuator [rad].
  double distance = 0.0;       ///< Distance driven, equal to the integral of |u| over time [m].
};

/// Returns the state of a car that rolls without slip. The argument `state` is the state of a
/// KinematicCar with the rear axle as its reference point.
SingleTrackState RollingWithoutSlip(const VehicleParams& params, const KinematicState& state);

/// Simulates a linear single-track car with prescribed speed. Guarantees: steering and speed are
/// exactly the same as in KinematicCar, including the rules for standstill and gears. The ratios
/// v/u and r/u of lateral speed and yaw rate to the speed are integrated by the Radau IIA method of
/// fifth order, in substeps of at most 2 ms. When the speed u passes through zero, the lateral
/// speed v and the yaw rate r decay infinitely fast. The ratios v/u and r/u have a finite limit at
/// zero speed. Because the ratios v/u and r/u have a limit at standstill, the model needs no
/// blending or switching at low speed. At a low speed u, the single-track car moves as the
/// kinematic car, with errors of the order u^2 and of the order of the acceleration u'. A
/// simulation step is split at the time when the steering reaches its target, and at the time when
/// the car comes to rest. Changing the step size changes the result by less than 1e-9 m and 1e-9
/// rad over seconds of driving. The single-track model is not meant for braking that is much harder
/// than tyres allow (about 50 m/s^2). The single-track model has linear tyres without a friction
/// limit, and no wheel loads, roll, wind or grades.
///
/// Throws InternalError unless mass, yaw inertia and both cornering stiffnesses are above zero.
/// SingleTrackCar needs about 2 us of computing time per 2 ms of simulated time.
class SingleTrackCar {
 public:
  SingleTrackCar(const VehicleParams& params, const SingleTrackState& start);

  /// Advances the car by `duration` [s], >= 0, under a constant command. Throws PreconditionError
  /// unless all arguments are finite.
  void Step(const Command& command, double duration);

  /// Displaces the car instantaneously by `left` [m] to its left.
  void ApplyLateralOffset(double left);

  /// Applies an impulse to the left [N s] at the center of gravity. An impulse has no effect on a
  /// car at rest, because the lateral speed of a car at rest is 0.
  void ApplyLateralForce(double impulse);

  [[nodiscard]] const SingleTrackState& state() const { return state_; }

  /// Returns the full state of the vehicle. The accelerations in the returned state are those at
  /// the end of the last step, and the state's `time` is the total duration of all steps. The
  /// returned state has no wheel forces, because the model only has axle forces.
  [[nodiscard]] VehicleState FullState() const;

 private:
  /// Vector of the ratios v/u [rad] and r/u [1/m], with lateral speed v, yaw rate r and speed u.
  using Ratios = Vec2;
  [[nodiscard]] Eigen::Matrix2d Decay(double speed, double acceleration_along) const;
  [[nodiscard]] Ratios RatiosAt(double direction, double acceleration) const;
  void Advance(const MotionPiece& piece);
  void StepByRadau(const MotionPiece& piece);

  VehicleParams params_;
  SingleTrackState state_;
  // Decay rate of the lateral speed v and the yaw rate r caused by the tyre forces, multiplied by
  // the speed |u| [m/s^2].
  Eigen::Matrix2d slip_rate_;
  // Gain from tan(delta) to the rates of lateral speed v and yaw rate r when driving forwards.
  Vec2 steer_gain_;
  double time_ = 0.0;
  double acceleration_ = 0.0;  // Acceleration at the end of the last step [m/s^2].
};

}  // namespace trackbed
