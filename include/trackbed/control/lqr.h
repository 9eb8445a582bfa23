#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"

namespace trackbed {

/// The linear-quadratic regulator with preview: minimizes
///   sum over control periods of  cross_track e^2 + heading (psi - psi_0)^2 + steering_rate w^2
/// for the linear error model (docs/algorithms/control.md). The minimization ignores the limits of
/// steering angle and rate.
///
/// Symbols: e, psi cross-track and heading error of the rear axle [m, rad]; w steering rate
/// [rad/s], the input, held over a control period; delta_0, psi_0 steering and heading error of the
/// steady turn on the path's curvature, with understeer; z the state's deviation from that turn;
/// g_k change of the path's curvature k periods ahead; K, P gain and solution of the discrete
/// Riccati equation; A_c = A - B K.
///   w = -K z - (R + B'PB)^-1 B' sum_k (A_c')^k P g_k
/// The car is modeled by the dynamic single-track model at the present speed, with the axle forces
/// that TyreForces selects. A car without tyre coefficients is modeled as kinematic. Both models
/// include the steering actuator and the steering lag. The gains are recomputed in each control
/// period for the present speed and direction of motion.
///
/// The steering rate is integrated from the last commanded angle, initially the actuator's angle.
/// The integration compensates delay, backlash and gain errors of the actuator.
///
/// On a path of constant curvature, a car without tracking error is steered at delta_0. Steering
/// rate and angle are clipped to the car's limits after the regulator has computed them. MpcOptions
/// describes a controller that accounts for the limits. The weight of the steering rate grows with
/// the car's distance from the path, so that the rate-limited steering can follow. The car
/// approaches the path at an angle of at most 0.6 rad. On reverse paths, the same model applies
/// with a negative speed u. Computing time per control period, with 100 periods of preview: 55 us
/// for a car on its path, 0.5 ms for a car several meters off its path. The controller allocates no
/// heap memory.
struct LqrOptions {
  std::optional<double> cross_track;  ///< Weight of the cross-track error [1/m^2], > 0; default:
                                      ///< (2.7/L)^2, with the wheelbase L in m.
  double heading = 1.0;               ///< Weight of the heading error [1/rad^2], >= 0.
  /// Weight of the steering rate [s^2/rad^2], > 0; default: (0.1506/omega)^2, with the car's
  /// maximum steering rate omega in rad/s.
  std::optional<double> steering_rate;
  double preview = 2.0;  ///< Time over which the path's curvature is previewed [s], >= 0.
  TyreForces tyres = TyreForces::kLinear;
};
void Visit(KeyVisitor& keys, LqrOptions& options);

ControllerEntry LqrController();

}  // namespace trackbed
