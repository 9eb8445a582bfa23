#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// How the preview controller turns the preview angle u into steering.
enum class PreviewLaw {
  kLinear,    ///< delta = (2 L/R) u: MacAdam's gain for a single point and the kinematic car
  kExactArc,  ///< delta = atan(2 L sin(u)/R): the circle through the point; pure pursuit
};

/// MacAdam's preview (MacAdam 1981) with a single point: the point P of the path at distance R from
/// the rear-axle center O, the first after the nearest one; u is the signed angle from the
/// direction of motion to OP. Beyond its end the path continues along its tangent. A car that is
/// further than R from the path steers toward the point R ahead of its nearest point.
///
/// The distance trades corner cutting, R^2/(8 r), against robustness to the limited steering rate.
/// Unless `distance` is given, R follows from the car, its speed and the path:
///   R = max(3/4 L,  3 v T,  0.65 S + v T)
///   T [s]  response time: control period + steering lag + m v/(C_f + C_r), the tyres' part 0 for a
///          car without tyre coefficients
///   S [m]  distance by which rate-limited steering lags behind the path: the largest
///          v abs(delta(s_2) - delta(s_1))/omega - (s_2 - s_1) of any two
///          stations s_1 < s_2 within R, with delta = atan(L kappa) of the path
/// with L wheelbase [m], v speed [m/s], omega steering rate [rad/s], C_f, C_r cornering stiffness
/// of the axles [N/rad], m mass [kg]. A car and a path of another size, with the same v/(L omega)
/// and v T/L, give the same relative error. Derivation and sources: docs/algorithms/control.md.
///
/// This distance suits a car on its path. To return from an offset e, it would require steering
/// faster than the limited rate, and the car would oscillate about the path. Therefore R is at
/// least 1.5 cbrt(e L v/omega), which is 0 for a car on its path.
struct PreviewOptions {
  std::optional<double> distance;  ///< shortest R [m], > 0; default: the law above
  double time = 0.0;               ///< R is at least time |v| [s]
  PreviewLaw law = PreviewLaw::kExactArc;
  /// Accounts for tyre slip: u is measured from the actual direction of motion of the rear axle,
  /// and the steering includes understeer. A given distance must be at least 0.5 s at 20 m/s; 0.3 s
  /// is unstable there.
  bool slip = false;
};
void Visit(KeyVisitor& keys, PreviewOptions& options);

ControllerEntry PreviewController();

/// The preview angle u [rad] of a car whose rear axle is at `pose`, looking `distance` [m] ahead
/// along `path` from `station`; positive when the point lies to the left.
double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance);

}  // namespace trackbed
