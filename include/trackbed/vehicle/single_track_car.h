#pragma once

#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

/// The linear dynamic single-track car (Riekert and Schunck 1940; Mitschke and Wallentowitz 2014)
/// behind a rate-limited steering actuator, with prescribed speed.
///
/// Symbols (ISO 8855): u speed along the car's x axis [m/s], signed, the same at every point of
/// that axis; v lateral speed at the center of gravity [m/s]; r yaw rate [rad/s]; delta steering;
/// m mass; I yaw inertia; l_f, l_r center of gravity to the axles; L = l_f + l_r; C_f, C_r the
/// axles' cornering stiffness [N/rad]; F_f, F_r their lateral forces [N], left positive.
///   m (v' + u r) = F_f + F_r         F_f = C_f (u tan(delta) - v - l_f r)/|u|
///   I r' = l_f F_f - l_r F_r         F_r = -C_r (v - l_r r)/|u|
/// Small slip angles: tan(alpha) is alpha, and all of F_f is along y. The steering angle and the
/// pose need not be small: with tan(delta), the car without slip is the kinematic one. The forces
/// oppose the axles' lateral motion in either direction of rolling.
///
/// Steady state: r = u tan(delta)/(L + K u |u|) with K = m (l_r/C_f - l_f/C_r)/L [s^2/m]. Like the
/// linear car, it is unstable above the speed sqrt(L/|K|) for K < 0 driving forwards, and for K > 0
/// driving backwards.
namespace trackbed {

struct SingleTrackState {
  Pose2 pose;                  ///< of the rear axle
  double speed = 0.0;          ///< u [m/s]
  double lateral_speed = 0.0;  ///< v [m/s]; 0 at rest
  double yaw_rate = 0.0;       ///< r [rad/s]; 0 at rest
  double steering = 0.0;       ///< delta, angle of the actuator [rad]
  double distance = 0.0;       ///< integral of |u| [m]
};

/// The state of a car that rolls without slip, from that of a KinematicCar with the rear axle as
/// reference.
SingleTrackState RollingWithoutSlip(const VehicleParams& params, const KinematicState& state);

/// Guarantees: steering and speed are exactly those of KinematicCar, including its rules of
/// standstill and gears. Integrates v/u and r/u by Radau IIA of fifth order, over at most 2 ms at a
/// time. These ratios have a finite limit where u passes through zero, where v and r themselves
/// decay infinitely fast: no blending or switching is needed, and a slow car equals the kinematic
/// one to O(u^2) and O(u'). Steps are split where the steering reaches its target and where the car
/// comes to rest; the step size changes the result by less than 1e-9 m and rad over seconds of
/// driving. Braking harder than tyres allow (some 50 m/s^2) is outside the model. Linear tyres have
/// no friction limit, wheel loads, roll, wind or grades.
///
/// Needs mass, yaw inertia and both cornering stiffnesses above zero (InternalError). Cost: about 2
/// us per 2 ms.
class SingleTrackCar {
 public:
  SingleTrackCar(const VehicleParams& params, const SingleTrackState& start);

  /// Advances by `duration` [s] >= 0 under a constant command. PreconditionError unless all
  /// arguments are finite.
  void Step(const Command& command, double duration);

  /// Displaces the car instantaneously by `left` [m] to its left.
  void ApplyLateralOffset(double left);

  /// Applies an impulse to the left [N s] at the center of gravity. No effect on a car at rest,
  /// which has no lateral speed.
  void ApplyLateralForce(double impulse);

  [[nodiscard]] const SingleTrackState& state() const { return state_; }

  /// As KinematicCar::FullState: accelerations are those at the end of the last step, `time` is the
  /// sum of the steps. Without wheel forces, since the model only has axle forces.
  [[nodiscard]] VehicleState FullState() const;

 private:
  /// v/u [rad] and r/u [1/m].
  using Ratios = Vec2;
  [[nodiscard]] Eigen::Matrix2d Decay(double speed, double acceleration_along) const;
  [[nodiscard]] Ratios RatiosAt(double direction, double acceleration) const;
  void Advance(const MotionPiece& piece);
  void StepByRadau(const MotionPiece& piece);

  VehicleParams params_;
  SingleTrackState state_;
  Eigen::Matrix2d slip_rate_;  // decay of v and r by the tyres, per unit of 1/|u| [m/s^2]
  Vec2 steer_gain_;            // of v and r, per unit of tan(delta)
  double time_ = 0.0;
  double acceleration_ = 0.0;  // at the end of the last step [m/s^2]
};

}  // namespace trackbed
