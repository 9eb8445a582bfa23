#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"

namespace trackbed {

/// Linear model-predictive control within the car's steering limits. The cost function of
/// LqrOptions is summed over the next `horizon` steps; the Riccati matrix P accounts for all later
/// steps:
///   minimize  sum_{k<N} (cross_track e_k^2 + heading (psi_k - psi_0)^2 + steering_rate w_k^2)
///             + z_N' P z_N
///   subject to  abs(w_k) <= omega,  abs(delta_k) <= delta_max  for every step
///
/// Symbols and model are those of LqrOptions; N is `horizon`. The steering rate w_k is constant
/// over a step. In each control period, the controller solves a quadratic program in the rates w_0
/// .. w_{N-1} (optimize/quadratic_program.h), and applies the first rate w_0 until the next period.
/// Solutions are not reused as starting points, because the search's first step reaches the optimum
/// from any start.
///
/// Guarantees: the actuator can turn from the last commanded angle to the new commanded angle
/// within one control period, and the new angle is within the steering limit. While no limit is
/// active, the controller equals the LQR with the same step and a preview of N steps. Far from the
/// path, the steering rate is weighted as in the LQR. The model has linear tyres and ignores speed
/// changes and saturation. On reverse paths, the same model applies with a negative speed u. Cost:
/// about 80 us per control period with 20 steps, and 160 us if a limit is active. The controller
/// allocates heap memory (in NLopt) only if a limit is active.
struct MpcOptions {
  static constexpr int kMaxHorizon = 40;

  std::optional<double> cross_track;    ///< Cross-track weight [1/m^2], > 0; default as in
                                        ///< LqrOptions.
  double heading = 1.0;                 ///< Weight of the heading error [1/rad^2], >= 0.
  std::optional<double> steering_rate;  ///< Rate weight [s^2/rad^2], > 0; default as in LqrOptions.
  int horizon = 20;                     ///< Number of steps N, 1 to kMaxHorizon.
  double step = 0.1;                    ///< Length of a step [s], > 0; at least the control period.
  TyreForces tyres = TyreForces::kLinear;
};
void Visit(KeyVisitor& keys, MpcOptions& options);

ControllerEntry MpcController();

}  // namespace trackbed
