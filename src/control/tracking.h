#pragma once

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"

namespace trackbed {

/// Position of a car relative to its path.
struct Tracking {
  PathPoint foot;  ///< Point of the path at the station of the car.
  /// Cross-track error e of the car [m], positive if the car is left of the path.
  double cross_track = 0.0;
  /// Heading error psi of the car relative to the path [rad], in (-pi, pi].
  double heading_error = 0.0;
};

Tracking ProjectOntoPath(const ControlInput& input);

/// Scales of a car relative to the Prius, for which the default gains and weights were chosen. If
/// lengths and times are measured in these scales, cars of any wheelbase and steering rate behave
/// alike.
struct CarScale {
  double length = 1.0;  ///< Ratio of the car's wheelbase to that of the Prius: L divided by 2.7 m.
  /// Ratio of the steering rate of the Prius to that of the car: 0.1506 rad/s divided by the
  /// maximum steering rate omega.
  double time = 1.0;
};

CarScale ComputeCarScale(const VehicleParams& vehicle);

/// Returns whether mass, inertia and tyre coefficients of the car are known, which dynamic models
/// require.
bool HasTyres(const VehicleParams& vehicle);

/// Cornering stiffness of each axle, the sum of its two tyres [N/rad].
struct CorneringStiffness {
  double front = 0.0;
  double rear = 0.0;
};

/// Returns the matrix of SingleTrackCar's lateral equations at the signed speed u: (v', r') =
/// matrix (v, r, tan(delta)).
Eigen::Matrix<double, 2, 3> LateralRates(const VehicleParams& vehicle,
                                         const CorneringStiffness& stiffness, double speed);

/// Steady circular motion of a car whose rear axle follows the circle. The turn is the steady state
/// of SingleTrackCar, or of KinematicCar for a car without tyre coefficients.
struct SteadyTurn {
  /// Steering angle delta_0 of the turn [rad], with tan(delta_0) = kappa (L + K u |u|).
  double steering = 0.0;
  /// Heading error psi_0 in the turn, equal to the negative slip angle of the rear axle [rad].
  double heading_error = 0.0;
  double lateral_speed = 0.0;  ///< Lateral speed v of the center of gravity in the turn [m/s].
  double yaw_rate = 0.0;       ///< Yaw rate of the car in the turn, r = u kappa [rad/s].
};

/// Computes the steady turn at `curvature` [1/m] and the signed `speed` u [m/s].
SteadyTurn SteadyTurnOn(const VehicleParams& vehicle, double curvature, double speed);

/// Motion that a car should have at a point of its path.
struct Motion {
  double curvature = 0.0;     ///< Curvature of the path at this point [1/m].
  double speed = 0.0;         ///< Signed speed u of the car [m/s].
  double acceleration = 0.0;  ///< Acceleration of the car, the rate of change of abs(u) [m/s^2].
};

/// A turn in which only the car's speed may change, with the stiffness of the axles in this turn.
struct TurnOperation {
  SteadyTurn turn;
  /// Cornering stiffness of the axles in the turn; 0 for a car without tyre coefficients.
  CorneringStiffness stiffness;
};

TurnOperation OperateOn(const VehicleParams& vehicle, TyreForces tyres, const Motion& motion);

}  // namespace trackbed
