#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"

namespace trackbed {

/// The linear-quadratic regulator with preview. For the linear error model
/// (docs/algorithms/control.md), the regulator minimizes the sum over all control periods of
///   cross_track e^2 + heading (psi - psi_0)^2 + steering_rate (w - r)^2.
/// The minimization includes the car's limit of the steering rate within the preview, but ignores
/// the limit of the steering angle.
///
/// Symbols: e, psi cross-track and heading error of the rear axle [m, rad]; w steering rate
/// [rad/s], the input, held over a control period; delta_0, psi_0 steering and heading error of the
/// steady turn on the path's curvature, with understeer; z the deviation of the state from that
/// turn; g_k change of the path's curvature k periods ahead; r_k steering rate of the steady turn k
/// periods ahead [rad/s], at most the car's largest rate; K gain, P solution of the discrete
/// Riccati equation; A_c = A - B K. The steering rate is
///   w = r_0 - K z - (R + B'PB)^-1 B' sum_k (A_c')^k P (g_k + B r_k)
/// unless the formula exceeds the limit of the steering rate within the preview. If the formula
/// exceeds the limit of the steering rate, the commanded rate w is the first input of a quadratic
/// program with this limit (src/control/bounded_regulator.h). Because of the rate limit in the
/// minimization, the wheels begin to turn back early enough. The car is modeled by the dynamic
/// single-track model at the present speed, with the axle forces that TyreForces selects. A car
/// without tyre coefficients is modeled as the kinematic car. The dynamic and the kinematic car
/// model both include the steering actuator and the steering lag. The regulator's gains are
/// recomputed in each control period for the present speed and direction of motion. The preview
/// assumes that the car drives the path ahead at the planned speeds.
///
/// The commanded angle is the integral of the steering rate, starting at the actuator's initial
/// angle. The integration of the steering rate compensates delay, backlash and gain errors of the
/// actuator.
///
/// On a path whose curvature changes as slowly as the wheels can turn, a car without tracking error
/// turns its wheels at the rates r_k. On a path of constant curvature, the regulator commands the
/// steady-turn angle delta_0 to a car without tracking error. The steering angle is clipped to the
/// car's limit after the regulator has computed it. Only the MPC controller (MpcOptions) includes
/// the limit of the steering angle in its optimization. The weight of the steering rate in the cost
/// grows with the car's distance from the path, so that the rate-limited steering can follow the
/// commands. The regulator limits the angle at which the car approaches the path to 0.6 rad. On
/// paths that are driven in reverse, the regulator uses the same model with a negative speed u.
/// Cost per control period, with a preview of 100 periods: 55 us for a car on its path; up to 0.5
/// ms more for a car several meters off its path, and up to 0.55 ms more while the regulator
/// predicts rates beyond the limit. The LQR controller allocates heap memory in its first control
/// period only.
struct LqrOptions {
  std::optional<double> cross_track;  ///< Weight of the cross-track error [1/m^2], > 0; default:
                                      ///< (2.7/L)^2, with the wheelbase L in m.
  double heading = 1.0;               ///< Weight of the heading error [1/rad^2], >= 0.
  /// Weight of the steering rate [s^2/rad^2], > 0; default: (0.1506/omega)^2, with the car's
  /// maximum steering rate omega in rad/s.
  std::optional<double> steering_rate;
  /// Time ahead over which the regulator takes the path's curvature into account [s], >= 0.
  double preview = 2.0;
  TyreForces tyres = TyreForces::kLinear;
};
void Visit(KeyVisitor& keys, LqrOptions& options);

ControllerEntry LqrController();

}  // namespace trackbed
