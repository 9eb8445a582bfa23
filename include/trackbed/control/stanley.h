#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// The law of the car Stanley (Hoffmann et al. 2007) for a path of the rear axle.
///
/// Symbols: e, psi cross-track and heading error of the rear axle [m, rad]; v speed; kappa the
/// path's curvature at the car; delta_0(kappa), psi_0(kappa) steering and heading error of the
/// steady turn on it: atan(L kappa) and 0 for a car without slip, with the understeer of the linear
/// single-track car if it has tyre coefficients.
///   forwards   delta = delta_0 - (psi - psi_0) - atan(k (e + L sin(psi - psi_0))/(k_s + |v|))
///   backwards  delta = delta_0 + (psi - psi_0) - atan(k e/(k_s + |v|))
/// The offset is that of the leading axle: forwards, e + L sin(psi - psi_0) is the distance of the
/// front axle from the path it follows when the rear axle is on its path. Without slip and with k_s
/// = 0 it shrinks as exp(-k t) when it is small, and at a rate of at most |v| when it is large.
/// Backwards the rear axle leads but does not steer: e oscillates with the damping ratio sqrt((k_s
/// + |v|)/(k L))/2, 0.6 at 3 m/s and 0.4 at 1 m/s for the Prius.
///
/// The defaults, with omega the steering rate [rad/s], give 1/s and 1 m/s for the Prius.
///
/// Has no preview, so that it lags a step of curvature by the steering ramp time, and no damping:
/// above some 10 m/s with the default k, where the yaw response lags, it oscillates, the more the
/// larger k is. It ignores the steering rate limit: the Prius at 3 m/s returns from an offset of
/// 1.5 m, but is unstable from an offset of 4 m.
struct StanleyOptions {
  std::optional<double> gain;       ///< k [1/s], > 0; none: 6.64 omega
  std::optional<double> softening;  ///< k_s [m/s], >= 0; none: 2.46 L omega
};
void Visit(KeyVisitor& keys, StanleyOptions& options);

ControllerEntry StanleyController();

}  // namespace trackbed
