#pragma once

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Where a car is beside its path.
struct Tracking {
  PathPoint foot;              ///< of the path, at the car's station
  double cross_track = 0.0;    ///< e [m], positive left of the path
  double heading_error = 0.0;  ///< psi [rad], in (-pi, pi]
};

Tracking ProjectOntoPath(const ControlInput& input);

/// Sizes of a car over those of the one that gains and weights were chosen for, the Prius. In these
/// units all cars are alike, as far as their wheelbase and steering rate go.
struct CarScale {
  double length = 1.0;  ///< of the wheelbase: L/2.7 m
  double time = 1.0;    ///< of the time the wheels need to turn: 0.1506 rad/s over omega
};

CarScale ComputeCarScale(const VehicleParams& vehicle);

/// Whether the car's tyres are known, so that it can be more than kinematic.
bool HasTyres(const VehicleParams& vehicle);

/// SingleTrackCar's equations at the signed speed u: (v', r') = rates (v, r, tan(delta)).
Eigen::Matrix<double, 2, 3> LateralRates(const VehicleParams& vehicle, double speed);

/// How a car runs on a circle with its rear axle on it: the steady state of SingleTrackCar, or of
/// KinematicCar for a car without tyre coefficients.
struct SteadyTurn {
  double steering = 0.0;       ///< delta_0 [rad]: tan(delta_0) = kappa (L + K u |u|)
  double heading_error = 0.0;  ///< psi_0 [rad]: the rear axle's slip, the other way round
  double lateral_speed = 0.0;  ///< v at the center of gravity [m/s]
  double yaw_rate = 0.0;       ///< r = u kappa [rad/s]
};

/// `speed` u is signed.
SteadyTurn SteadyTurnOn(const VehicleParams& vehicle, double curvature, double speed);

}  // namespace trackbed
