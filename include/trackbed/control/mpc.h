#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"

namespace trackbed {

/// Linear model-predictive controller that respects the car's limits on steering angle and rate.
/// The cost function of LqrOptions is summed over the next `horizon` steps; the Riccati matrix P
/// accounts for all later steps:
///   minimize  sum_{k<N} (cross_track e_k^2 + heading (psi_k - psi_0)^2 + steering_rate (w_k -
///   r_k)^2)
///             + z_N' P z_N
///   subject to  abs(w_k) <= omega,  abs(delta_k) <= delta_max  for every step.
///
/// The symbols and the model are the same as in LqrOptions; N is the option `horizon`. The steering
/// rate w_k is constant over the step k. In each control period, the controller solves a quadratic
/// program for the steering rates w_0 .. w_{N-1} of N steps (optimize/quadratic_program.h). The
/// first steering rate, w_0, is applied until the next control period. The solver does not start
/// from the previous solution, because the solver's first step reaches the optimum from any
/// starting point.
///
/// Guarantees: the actuator can turn from the last commanded angle to the new commanded angle
/// within one control period, and the new angle is within the steering limit. While no limit is
/// active and the speed is constant, the commands equal those of the LQR controller with the same
/// step and a preview of N steps. Far from the path, the weight of the steering rate grows in the
/// same way as for the LQR controller. The model of each prediction step uses the planned speed at
/// this step, plus the present difference between the car's speed and the planned speed. On paths
/// that are driven in reverse, the controller uses the same model with a negative speed u. Cost:
/// about 80 us per control period with 20 steps, and 160 us if a limit is active. The MPC
/// controller allocates heap memory (in NLopt) only if a limit is active.
struct MpcOptions {
  static constexpr int kMaxHorizon = 40;

  /// Weight of the cross-track error [1/m^2], > 0; same default as in LqrOptions.
  std::optional<double> cross_track;
  double heading = 1.0;  ///< Weight of the heading error [1/rad^2], >= 0.
  /// Weight of the steering rate [s^2/rad^2], > 0; same default as in LqrOptions.
  std::optional<double> steering_rate;
  int horizon = 20;  ///< Number N of steps in the prediction horizon, from 1 to kMaxHorizon.
  /// Duration of a prediction step [s], > 0; at least the control period. Default: 0.1 s; longer if
  /// the wheels need more than `horizon` steps of 0.1 s to turn from straight ahead to their limit.
  std::optional<double> step;
  TyreForces tyres = TyreForces::kLinear;
};
void Visit(KeyVisitor& keys, MpcOptions& options);

ControllerEntry MpcController();

}  // namespace trackbed
