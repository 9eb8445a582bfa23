#pragma once

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"
#include "trackbed/vehicle/steady_turn.h"

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

/// Returns whether the rear axle moves sideways, which is impossible for a kinematic car.
bool RearAxleSlips(const ControlInput& input);

/// Speed below which controllers use the kinematic model of the car [m/s]. At 1 m/s, the kinematic
/// and the dynamic model differ by less than 1 %.
inline constexpr double kMinDynamicSpeed = 1.0;

/// Length and time scales of a car relative to the Prius, for which the default gains and weights
/// were chosen. If lengths and times are measured in these scales, cars of any wheelbase and
/// steering rate behave alike.
struct CarScale {
  double length = 1.0;  ///< Ratio of the car's wheelbase to that of the Prius: L divided by 2.7 m.
  /// Ratio of the steering rate of the Prius to that of the car: 0.1506 rad/s divided by the
  /// maximum steering rate omega.
  double time = 1.0;
};

CarScale ComputeCarScale(const VehicleParams& vehicle);

/// Returns the matrix of SingleTrackCar's lateral equations at the signed speed u: (v', r') =
/// matrix (v, r, tan(delta)), with lateral speed v and yaw rate r.
Eigen::Matrix<double, 2, 3> LateralRates(const VehicleParams& vehicle,
                                         const AxleStiffness& stiffness, double speed);

/// Motion that a car should have at a point of its path.
using Motion = TurnMotion;

/// Returns the steady turn of a car with the given model of its tyres. With kBrush, the turn
/// includes the load transfer of the acceleration.
TurnOperation OperateOn(const VehicleParams& vehicle, TyreForces tyres, const Motion& motion);

}  // namespace trackbed
