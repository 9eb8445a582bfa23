#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"

namespace trackbed {

/// Linear model-predictive control within the car's steering limits. The cost is that of LqrOptions
/// over the next `horizon` steps; the Riccati matrix P accounts for all later steps:
///   minimize  sum_{k<N} (cross_track e_k^2 + heading (psi_k - psi_0)^2 + steering_rate w_k^2)
///             + z_N' P z_N
///   subject to  abs(w_k) <= omega,  abs(delta_k) <= delta_max  for every step
///
/// Symbols and model are those of LqrOptions; N is `horizon`. The steering rate w_k is constant
/// over a step. The condensed program in w_0 .. w_{N-1} is solved in each control period
/// (optimize/quadratic_program.h), and its first rate is applied until the next period. No solution
/// is kept between periods, because the search's first step reaches the optimum from any start.
///
/// Guarantees: the actuator can reach the wanted angle within the period from the last commanded
/// angle (as in LqrOptions), and the angle is within the limit. While no limit is active, the
/// controller equals the LQR with the same step and a preview of N steps. Far from the path, the
/// steering rate is weighted as in the LQR. The model has linear tyres and ignores speed changes
/// and saturation. Reverse paths use the same model with u < 0. Cost: about 80 us with 20 steps,
/// twice that if a limit is active; only then NLopt uses heap memory.
struct MpcOptions {
  static constexpr int kMaxHorizon = 40;

  std::optional<double> cross_track;    ///< Weight [1/m^2], > 0; none: that of LqrOptions.
  double heading = 1.0;                 ///< Weight [1/rad^2], >= 0.
  std::optional<double> steering_rate;  ///< Weight [s^2/rad^2], > 0; none: that of LqrOptions.
  int horizon = 20;                     ///< Number of steps N, 1 to kMaxHorizon.
  double step = 0.1;                    ///< Length of a step [s], > 0; at least the control period.
  TyreForces tyres = TyreForces::kLinear;
};
void Visit(KeyVisitor& keys, MpcOptions& options);

ControllerEntry MpcController();

}  // namespace trackbed
