#pragma once

#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

/// The kinematic single-track car (Rajamani 2012, ch. 2; Skackauskas et al. 2017, eqs. (4)-(7))
/// behind a rate-limited steering actuator.
///
/// Symbols: psi yaw [rad], delta steering angle [rad], v speed [m/s], L wheelbase, l_g distance
/// from the rear axle to the center of gravity, beta = atan(l_g tan(delta)/L) sideslip angle at the
/// center of gravity [rad]. The equations of motion for the two reference points are:
///   rear axle:          x' = v cos psi          psi' = v tan(delta)/L
///   center of gravity:  x' = v cos(psi + beta)  psi' = v cos(beta) tan(delta)/L
namespace trackbed {

struct MotionPiece;

/// The reference point of a car, which is the point whose pose and speed the state contains.
enum class ReferencePoint { kRearAxle, kCenterOfGravity };

struct KinematicState {
  Pose2 pose;             ///< Pose of the car's reference point.
  double speed = 0.0;     ///< Speed v of the reference point [m/s], signed.
  double steering = 0.0;  ///< Steering angle delta of the actuator [rad].
  double distance = 0.0;  ///< Distance driven, equal to the integral of |v| over time [m].
};

/// The kinematic car. Guarantees: a step at a constant steering angle is exact except for rounding
/// errors, for any duration and acceleration. While the steering angle changes, the position error
/// is that of a fourth-order integrator: below 1e-10 m for steps up to 20 ms at 3 m/s. A simulation
/// step is split at the time when the steering reaches its target, and at the time when the car
/// comes to rest. Because each step is split when the steering reaches its target or the car comes
/// to rest, the result does not depend on the step size. The kinematic car has no slip, roll or
/// forces, and its acceleration follows the command exactly.
class KinematicCar {
 public:
  KinematicCar(const VehicleParams& params, ReferencePoint reference, const KinematicState& start);

  /// Advances the car by `duration` [s], >= 0, under a constant command. Throws PreconditionError
  /// unless all arguments are finite.
  void Step(const Command& command, double duration);

  /// Displaces the car instantaneously by `left` [m] to its left.
  void ApplyLateralOffset(double left);

  [[nodiscard]] const KinematicState& state() const { return state_; }

  /// Returns the full state of the vehicle. The pose and speed in the returned state are those of
  /// the rear axle, for either reference point. The accelerations in the returned state are those
  /// at the end of the last step. The member `time` of the returned state is the total duration of
  /// all steps.
  [[nodiscard]] VehicleState FullState() const;

 private:
  struct Rates {
    Vec2 velocity;
    double yaw_rate;
  };
  [[nodiscard]] Rates RatesAt(double yaw, double speed, double steering) const;
  [[nodiscard]] double Slip(double steering) const;
  void Advance(const MotionPiece& piece);
  [[nodiscard]] Pose2 PoseAfter(const MotionPiece& piece, double moved) const;

  VehicleParams params_;
  ReferencePoint reference_;
  KinematicState state_;
  double time_ = 0.0;
  double steering_rate_ = 0.0;  // Steering rate at the end of the last step [rad/s].
  double acceleration_ = 0.0;   // Acceleration at the end of the last step [m/s^2].
};

}  // namespace trackbed
