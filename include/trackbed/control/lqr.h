#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"

namespace trackbed {

/// The linear-quadratic regulator with preview: minimizes
///   sum over control periods of  cross_track e^2 + heading (psi - psi_0)^2 + steering_rate w^2
/// for the linear error model (docs/algorithms/control.md), without limits.
///
/// Symbols: e, psi cross-track and heading error of the rear axle [m, rad]; w steering rate
/// [rad/s], the input, held over a control period; delta_0, psi_0 steering and heading error of the
/// steady turn on the path's curvature, with understeer; z the state's deviation from that turn;
/// g_k change of the path's curvature k periods ahead; K, P gain and solution of the discrete
/// Riccati equation; A_c = A - B K.
///   w = -K z - (R + B'PB)^-1 B' sum_k (A_c')^k P g_k
/// The car is the dynamic single-track model at the present speed with the axles of TyreForces, or
/// the kinematic model if it has no tyre coefficients, behind its steering actuator and lag. Gains
/// are computed in each period for the present speed and direction.
///
/// The steering rate is integrated from the last commanded angle, initially the actuator's angle.
/// The integration compensates delay, backlash and gain errors of the actuator.
///
/// On a path of constant curvature, a car without error is steered at delta_0. Rate and angle are
/// clipped to the car's limits afterwards; the regulator does not account for them: see MpcOptions.
/// The weight of the rate grows with the distance from the path, so that the rate-limited steering
/// can follow and the car approaches the path at 0.6 rad at most. Reverse paths use the same model
/// with u < 0. Cost with 100 periods of preview: 55 us for a car on its path, 0.5 ms for a car
/// meters off its path. Uses no heap memory.
struct LqrOptions {
  std::optional<double> cross_track;  ///< Weight [1/m^2], > 0; none: (2.7 m/L)^2 per m^2.
  double heading = 1.0;               ///< Weight [1/rad^2], >= 0.
  /// Weight [s^2/rad^2], > 0; none: (0.1506 rad/s over omega)^2.
  std::optional<double> steering_rate;
  double preview = 2.0;  ///< Preview time of the path's curvature [s], >= 0.
  TyreForces tyres = TyreForces::kLinear;
};
void Visit(KeyVisitor& keys, LqrOptions& options);

ControllerEntry LqrController();

}  // namespace trackbed
