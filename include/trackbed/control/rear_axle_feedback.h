#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Controller by Lyapunov feedback of the rear axle's tracking errors (Paden et al. 2016, "rear
/// wheel position based feedback"), for forward and reverse paths.
///
/// Symbols: e, psi cross-track and heading error of the rear axle [m, rad]; D = +1 forwards, -1
/// backwards; kappa the path's curvature at the car, with ramps instead of steps that the wheels
/// cannot follow (docs/algorithms/control.md, "Ramped path"); psi_0(kappa) the heading error of the
/// steady turn on that curvature, 0 for a car without slip; d the option `distance` [m]. With the
/// path's curvature kappa, the tracking errors e and psi, and the symbols d, D and psi_0, the
/// commanded curvature is
///   kappa_c = kappa cos(psi - psi_0)/(1 - kappa e) - D 2 (psi - psi_0)/d
///             - e sinc(psi - psi_0)/d^2.
/// For a car without slip, the commanded steering angle is atan(L kappa_c), with the wheelbase L.
/// For a car with tyre coefficients, the commanded steering angle is that of a steady turn of the
/// linear single-track car with the curvature kappa_c, and thus includes the understeer.
///
/// If the car has no slip and its wheels follow the command immediately, the measure (e/d)^2 +
/// psi^2 of the tracking errors e and psi never grows (d is the option `distance`). On a path of
/// curvature kappa, the car returns to the path from every cross-track error e with kappa e < 1.
/// Small tracking errors are critically damped and decay as exp(-s/d), where s is the distance
/// driven.
///
/// The default of the distance d accounts for the rate limit of the wheels and for the response
/// time T of the car. By default, the distance d is the largest of ReturnDistance for the offset e,
/// ReturnDistance for the offset L/8, and 3 |v| T with the response time T
/// (src/control/preview_distance.h).
///
/// The control law has no preview, so at a curvature step the steering lags by the time that the
/// wheels need to turn. By default, the controller begins to turn the wheels back early enough for
/// their limited rate (src/control/timely_steering.h). If the option `distance` is given, the
/// controller does not turn the wheels back early (no timely steering).
struct RearAxleFeedbackOptions {
  /// Decay distance d of small tracking errors [m], >= 0.01; by default computed from the car, its
  /// speed and the cross-track error.
  std::optional<double> distance;
};
void Visit(KeyVisitor& keys, RearAxleFeedbackOptions& options);

ControllerEntry RearAxleFeedbackController();

}  // namespace trackbed
