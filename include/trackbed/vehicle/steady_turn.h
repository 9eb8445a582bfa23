#pragma once

#include "trackbed/vehicle/params.h"

/// Computes the steering of a car on its tyres in steady circular motion. Planners and controllers
/// use the same functions, so a plan requires the steering that the controllers command.
///
/// Symbols: kappa is the curvature of the path of the rear axle [1/m], u the signed speed of the
/// car [m/s], negative in reverse, m the mass [kg], L the wheelbase [m], and w_f and w_r the
/// fractions of the weight on the front and rear axle. Each axle carries its fraction of the
/// lateral force m u^2 kappa (mass m, speed u, curvature kappa). Slip angles s_f and s_r of the
/// axles have the sign of the lateral force. The steering angle delta satisfies
///   tan(delta) = L kappa + sign(u) (s_f - s_r),
/// with the wheelbase L and the slip angles s_f and s_r.
/// For a car without tyre coefficients, the slip angles are 0 and delta = atan(L kappa).
namespace trackbed {

/// Returns whether mass, inertia and tyre coefficients of the car are known, which dynamic models
/// require.
bool HasTyres(const VehicleParams& vehicle);

/// Cornering stiffness of each axle, the sum of its two tyres [N/rad].
struct AxleStiffness {
  double front = 0.0;
  double rear = 0.0;
};

/// Steady circular motion of a car whose rear axle follows the circle.
struct SteadyTurn {
  double steering = 0.0;  ///< Steering angle delta of the turn [rad].
  /// Heading error in the turn, equal to the negative slip angle of the rear axle [rad].
  double heading_error = 0.0;
  double lateral_speed = 0.0;  ///< Lateral speed of the center of gravity in the turn [m/s].
  double yaw_rate = 0.0;       ///< Yaw rate of the car in the turn, r = u kappa [rad/s].
};

/// Motion of a car in a turn.
struct TurnMotion {
  double curvature = 0.0;     ///< Curvature kappa of the path [1/m].
  double speed = 0.0;         ///< Signed speed u of the car [m/s].
  double acceleration = 0.0;  ///< Acceleration of the car, the rate of change of abs(u) [m/s^2].
  double road = 1.0;          ///< Factor of the road on the tyres' friction [1], > 0.
};

/// A turn in which only the car's speed may change, with the stiffness of the axles in this turn.
struct TurnOperation {
  SteadyTurn turn;
  /// Cornering stiffness of the axles in the turn; 0 for a car without tyre coefficients.
  AxleStiffness stiffness;
};

/// Returns the steady turn of a car whose tyres do not slip: the steady state of KinematicCar.
SteadyTurn TurnWithoutSlip(const VehicleParams& vehicle, double curvature, double speed);

/// Returns the steady turn of a car whose slip angles are proportional to the lateral forces: the
/// steady state of SingleTrackCar. The steering angle delta of this turn follows from tan(delta) =
/// kappa (L + K u |u|), with the understeer gradient K, the wheelbase L and the signed speed u.
/// SteadyTurnOn assumes that a car without tyre coefficients does not slip.
SteadyTurn SteadyTurnOn(const VehicleParams& vehicle, double curvature, double speed);

/// Returns the steady turn of a car whose axles follow the brush model (Pacejka 2012, ch. 3). The
/// stiffness and the friction force of an axle are proportional to its load, which changes with the
/// acceleration. The road's friction factor scales the friction force of an axle, but not its
/// stiffness. Lateral forces of more than 0.95 of the friction force cause no more slip. If the
/// friction or the axle loads are unknown, BrushTurnOn returns the turn of SteadyTurnOn.
TurnOperation BrushTurnOn(const VehicleParams& vehicle, const TurnMotion& motion);

/// Motion of a car in a bend whose curvature and speed change.
struct BendMotion {
  double curvature = 0.0;     ///< Curvature kappa of the path [1/m].
  double sharpness = 0.0;     ///< Derivative of kappa by the station [1/m^2].
  double speed = 0.0;         ///< Signed speed u of the car [m/s].
  double acceleration = 0.0;  ///< Rate of change of the speed abs(u) [m/s^2].
  double road = 1.0;          ///< Factor of the road on the tyres' friction [1], > 0.
};

/// Returns the steering angle delta of the turn at constant speed [rad]: BrushTurnOn without the
/// load transfer of the acceleration.
double SteeringInBend(const VehicleParams& vehicle, const BendMotion& motion);

/// Derivatives of SteeringInBend, the steering angle delta of a turn at constant speed.
struct SteeringSlopes {
  double by_curvature = 0.0;  ///< Derivative of the steering angle by the curvature [rad m].
  double by_speed = 0.0;      ///< Derivative of the steering angle by the speed abs(u) [rad s/m].
};
SteeringSlopes SteeringSlopesInBend(const VehicleParams& vehicle, const BendMotion& motion);

/// Returns the rate d delta/dt of SteeringInBend [rad/s] along the bend, due to the changes of
/// curvature and of speed.
double SteeringRateInBend(const VehicleParams& vehicle, const BendMotion& motion);

}  // namespace trackbed
