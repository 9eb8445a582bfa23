#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// The steering law of the autonomous car Stanley (Hoffmann et al. 2007), applied to a path of the
/// rear axle.
///
/// Symbols: e, psi cross-track and heading error of the rear axle [m, rad]; v speed; kappa the
/// path's curvature at the car; delta_0(kappa), psi_0(kappa) steering and heading error of the
/// steady turn on that curvature. For a car with the wheelbase L and without slip, the steady turn
/// has delta_0 = atan(L kappa) and psi_0 = 0. For a car with tyre coefficients, delta_0 and psi_0
/// of the steady turn include the understeer of the linear single-track car. With the gain k and
/// the softening speed k_s, the commanded steering angle is:
///   forwards   delta = delta_0 - (psi - psi_0) - atan(k (e + L sin(psi - psi_0))/(k_s + |v|))
///   backwards  delta = delta_0 + (psi - psi_0) - atan(k e/(k_s + |v|)).
/// The Stanley law corrects the offset of the axle that leads in the direction of motion. When the
/// car drives forwards, the law corrects the offset e + L sin(psi - psi_0) of the front axle. The
/// offset e + L sin(psi - psi_0) is the distance between the front axle and its line of motion when
/// the rear axle is exactly on the path. Without slip and with the softening speed k_s = 0, a small
/// offset decays over time as exp(-k t), and a large offset decays at a rate of at most |v|. When
/// the car drives backwards, the rear axle leads but does not steer, so the cross-track error e
/// oscillates with the damping ratio sqrt((k_s + |v|)/(k L))/2 (gain k, softening speed k_s). For
/// the Prius in reverse, the damping ratio is 0.6 at 3 m/s and 0.4 at 1 m/s.
///
/// For the Prius, the default gain k is 1 per second, and the default softening speed k_s is 1 m/s.
///
/// The Stanley law has no preview, but tracks a path whose curvature steps are ramps that the
/// wheels can follow (docs/algorithms/control.md, "Ramped path"). The Stanley law ignores the
/// response time T of wheels and tyres: a car that drives farther than its wheelbase L in the time
/// 3 T oscillates. To avoid oscillations, the law without a given `gain` is that of a longer car
/// with the wheelbase D = max(L, 3 |v| T). For this car, D replaces L in the law, the feedback is
/// multiplied by L/D, and k/(k_s + |v|) is at most 1/(6 |v| T). T is the response time of
/// docs/algorithms/control.md, "The default distance".
///
/// By default, the controller begins to turn the wheels back early enough for their limited rate
/// (src/control/timely_steering.h). If the option `gain` is given, the law ignores the limit on the
/// steering rate. With a given `gain` at 3 m/s, the Prius returns from an offset of 1.5 m, but is
/// unstable from an offset of 4 m.
struct StanleyOptions {
  /// Gain k on the offset [1/s], > 0; default: 6.64 omega, with the maximum steering rate omega
  /// [rad/s].
  std::optional<double> gain;
  /// Softening speed k_s [m/s], >= 0; default: 2.46 L omega, with the wheelbase L [m] and the
  /// maximum steering rate omega [rad/s].
  std::optional<double> softening;
};
void Visit(KeyVisitor& keys, StanleyOptions& options);

ControllerEntry StanleyController();

}  // namespace trackbed
