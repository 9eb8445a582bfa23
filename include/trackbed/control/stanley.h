#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// The steering law of the car Stanley (Hoffmann et al. 2007), for a path of the rear axle.
///
/// Symbols: e, psi cross-track and heading error of the rear axle [m, rad]; v speed; kappa the
/// path's curvature at the car; delta_0(kappa), psi_0(kappa) steering and heading error of the
/// steady turn on that curvature. For a car without slip, delta_0 = atan(L kappa) and psi_0 = 0.
/// For a car with tyre coefficients, they include the understeer of the linear single-track car.
///   forwards   delta = delta_0 - (psi - psi_0) - atan(k (e + L sin(psi - psi_0))/(k_s + |v|))
///   backwards  delta = delta_0 + (psi - psi_0) - atan(k e/(k_s + |v|))
/// The law corrects the offset of the leading axle. Forwards, that offset is e + L sin(psi -
/// psi_0), the distance of the front axle from its path when the rear axle is on the path. Without
/// slip and with k_s = 0, a small offset shrinks as exp(-k t), a large one at a rate of at most
/// |v|. Backwards, the rear axle leads but does not steer, so e oscillates with the damping ratio
/// sqrt((k_s + |v|)/(k L))/2, 0.6 at 3 m/s and 0.4 at 1 m/s for the Prius.
///
/// For the Prius, the default gain k is 1/s and the default softening speed k_s is 1 m/s.
///
/// The law has no preview: at a curvature step, the steering lags by the time that the wheels need
/// to turn. The law has no damping: above 10 m/s with the default gain k, the yaw response lags and
/// the car oscillates; a larger k makes the oscillation worse. The law ignores the steering rate
/// limit: the Prius at 3 m/s returns from an offset of 1.5 m, but is unstable from an offset of 4
/// m.
struct StanleyOptions {
  std::optional<double> gain;       ///< Gain k [1/s], > 0; default: 6.64 omega, with the maximum
                                    ///< steering rate omega [rad/s].
  std::optional<double> softening;  ///< Softening speed k_s [m/s], >= 0; default: 2.46 L omega.
};
void Visit(KeyVisitor& keys, StanleyOptions& options);

ControllerEntry StanleyController();

}  // namespace trackbed
