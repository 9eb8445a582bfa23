#pragma once

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"

namespace trackbed {

/// Position of a car relative to its path.
struct Tracking {
  PathPoint foot;              ///< Point of the path at the car's station.
  double cross_track = 0.0;    ///< Cross-track error e [m], positive left of the path.
  double heading_error = 0.0;  ///< Heading error psi [rad], in (-pi, pi].
};

Tracking ProjectOntoPath(const ControlInput& input);

/// Scales of a car relative to the Prius, for which the default gains and weights were chosen. If
/// lengths and times are measured in these scales, cars of any wheelbase and steering rate behave
/// alike.
struct CarScale {
  double length = 1.0;  ///< Scale of lengths: the wheelbase L over 2.7 m.
  double time = 1.0;    ///< Scale of times: 0.1506 rad/s over the maximum steering rate omega.
};

CarScale ComputeCarScale(const VehicleParams& vehicle);

/// Returns whether mass, inertia and tyre coefficients are known, so that dynamic models of the car
/// apply.
bool HasTyres(const VehicleParams& vehicle);

/// Cornering stiffness of both tyres of each axle [N/rad].
struct CorneringStiffness {
  double front = 0.0;
  double rear = 0.0;
};

/// Returns the matrix of SingleTrackCar's lateral equations at the signed speed u: (v', r') =
/// matrix (v, r, tan(delta)).
Eigen::Matrix<double, 2, 3> LateralRates(const VehicleParams& vehicle,
                                         const CorneringStiffness& stiffness, double speed);

/// Steady circular motion of a car whose rear axle is on the circle. The turn is the steady state
/// of SingleTrackCar, or of KinematicCar for a car without tyre coefficients.
struct SteadyTurn {
  double steering = 0.0;       ///< Steering angle delta_0 [rad], with tan(delta_0) = kappa (L + K u
                               ///< |u|).
  double heading_error = 0.0;  ///< Heading error psi_0 [rad]: the negative slip angle of the rear
                               ///< axle.
  double lateral_speed = 0.0;  ///< Lateral speed v at the center of gravity [m/s].
  double yaw_rate = 0.0;       ///< Yaw rate r = u kappa [rad/s].
};

/// Computes the steady turn at `curvature` [1/m] and the signed `speed` u [m/s].
SteadyTurn SteadyTurnOn(const VehicleParams& vehicle, double curvature, double speed);

/// The intended motion of a car.
struct Motion {
  double curvature = 0.0;     ///< Curvature of the path [1/m].
  double speed = 0.0;         ///< Speed u [m/s], signed.
  double acceleration = 0.0;  ///< Rate of change of abs(u) [m/s^2].
};

/// A turn in which only the speed may change, and the stiffness of the axles in the turn.
struct TurnOperation {
  SteadyTurn turn;
  CorneringStiffness stiffness;  ///< stiffness of the axles; 0 without tyre coefficients
};

TurnOperation OperateOn(const VehicleParams& vehicle, TyreForces tyres, const Motion& motion);

}  // namespace trackbed
