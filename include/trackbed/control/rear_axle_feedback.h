#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Lyapunov feedback of the rear axle's errors (Paden et al. 2016, "rear wheel position based
/// feedback"), on forward and reverse paths.
///
/// Symbols: e, psi cross-track and heading error of the rear axle [m, rad]; D = +1 forwards, -1
/// backwards; kappa the path's curvature at the car; psi_0(kappa) the heading error of the steady
/// turn on that curvature, 0 for a car without slip; d the option `distance` [m].
///   kappa_c = kappa cos(psi - psi_0)/(1 - kappa e) - D 2 (psi - psi_0)/d - e sinc(psi - psi_0)/d^2
/// The command is the steering of the steady turn with curvature kappa_c: atan(L kappa_c) for a car
/// without slip, with the understeer of the linear single-track car if it has tyre coefficients.
///
/// For a car without slip whose wheels follow the command at once, (e/d)^2 + psi^2 never grows. The
/// car returns to the path from any errors with kappa e < 1. Small errors decay as exp(-s/d),
/// critically damped, where s is the distance driven.
///
/// The default d accounts for the rate limit of the wheels and for the response time T of the car.
/// The default d is the largest of ReturnDistance for the offset e, ReturnDistance for the offset
/// L/8, and 3 |v| T (src/control/preview_distance.h).
///
/// The law has no preview: at a curvature step, the steering lags by the time that the wheels need
/// to turn.
struct RearAxleFeedbackOptions {
  /// Decay distance d of small errors [m], >= 0.01; computed from car, speed and cross-track error
  /// by default.
  std::optional<double> distance;
};
void Visit(KeyVisitor& keys, RearAxleFeedbackOptions& options);

ControllerEntry RearAxleFeedbackController();

}  // namespace trackbed
