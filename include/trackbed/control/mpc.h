#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/control/tyre_forces.h"

namespace trackbed {

/// Linear model-predictive control: the cost of LqrOptions over the next `horizon` steps, with the
/// infinite rest behind them by the Riccati matrix, within the car's steering limits:
///   minimize  sum_{k<N} (cross_track e_k^2 + heading (psi_k - psi_0)^2 + steering_rate w_k^2)
///             + z_N' P z_N
///   subject to  abs(w_k) <= omega,  abs(delta_k) <= delta_max  for every step
///
/// Symbols and model as in LqrOptions; N `horizon`; the steering rate w_k is held over a step. The
/// condensed program in w_0 .. w_{N-1} is solved in each control period
/// (optimize/quadratic_program.h), and its first rate is applied until the next. It keeps no
/// solution from one period to the next: the search's first step is the optimum from any start.
///
/// Guarantees: the wanted angle is within the limit, and within what the actuator reaches in the
/// period from the last commanded angle (as in LqrOptions). Where no limit is active it is the LQR
/// with the same step and a preview of N steps. Far from its path its rate is weighted as in the
/// LQR. With linear tyres it does not account for speed changes or saturation. Reverse paths are
/// the same model with u < 0. Cost: about 80 us with 20 steps, twice that where a limit is active;
/// heap memory only NLopt's, and only there.
struct MpcOptions {
  static constexpr int kMaxHorizon = 40;

  std::optional<double> cross_track;    ///< [1/m^2], > 0; none: as LqrOptions
  double heading = 1.0;                 ///< [1/rad^2], >= 0
  std::optional<double> steering_rate;  ///< [s^2/rad^2], > 0; none: as LqrOptions
  int horizon = 20;                     ///< N, 1 to kMaxHorizon
  double step = 0.1;                    ///< [s], > 0; the control period if that is longer
  TyreForces tyres = TyreForces::kLinear;
};
void Visit(KeyVisitor& keys, MpcOptions& options);

ControllerEntry MpcController();

}  // namespace trackbed
