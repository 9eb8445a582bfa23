#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// How the preview controller turns the preview angle u into steering.
enum class PreviewLaw {
  /// delta = (2 L/R) u: MacAdam's gain for a single point and the kinematic car.
  kLinear,
  /// delta = atan(2 L sin(u)/R): steers on the circle through the point, as pure pursuit.
  kExactArc,
};

/// MacAdam's preview (MacAdam 1981) with a single point P: the first point of the path, after the
/// nearest point, at distance R from the rear-axle center O. The preview angle u is the signed
/// angle from the direction of motion to OP. Beyond its end the path continues along its tangent. A
/// car that is further than R from the path steers toward the point R ahead of its nearest point.
///
/// A long distance R cuts corners, by R^2/(8 r). A short distance is less robust to the limited
/// steering rate. Unless `distance` is given, R follows from the car, its speed and the path:
///   R = max(3/4 L,  3 v T,  0.65 S + v T)
///   T [s]  response time: control period + steering lag + m v/(C_f + C_r), the tyres' part 0 for a
///          car without tyre coefficients
///   S [m]  distance by which rate-limited steering lags behind the path: the largest
///          v abs(delta(s_2) - delta(s_1))/omega - (s_2 - s_1) of any two
///          stations s_1 < s_2 within R, with delta = atan(L kappa) of the path
/// with L wheelbase [m], v speed [m/s], omega steering rate [rad/s], C_f, C_r cornering stiffness
/// of the axles [N/rad], m mass [kg]. The relative error depends on v/(L omega) and v T/L, not on
/// the size of car and path. Derivation and sources: docs/algorithms/control.md.
///
/// The distance of this law suits a car on its path. At an offset e from the path, that distance
/// would require steering faster than the limited rate. The car would then oscillate about the
/// path. Therefore R is at least 1.5 cbrt(e L v/omega), which is 0 for a car on its path.
struct PreviewOptions {
  std::optional<double> distance;  ///< Shortest R [m], > 0; by default the distance given above.
  double time = 0.0;               ///< Lower bound on R as a time [s]: R is at least time |v|.
  PreviewLaw law = PreviewLaw::kExactArc;
  /// Whether to account for tyre slip: u is measured from the actual direction of motion of the
  /// rear axle, and the steering includes understeer. At 20 m/s, a given distance must be at least
  /// 0.5 s of driving; 0.3 s is unstable.
  bool slip = false;
};
void Visit(KeyVisitor& keys, PreviewOptions& options);

ControllerEntry PreviewController();

/// The preview angle u [rad] of a car whose rear axle is at `pose`, looking `distance` [m] ahead
/// along `path` from `station`; positive when the point lies to the left.
double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance);

}  // namespace trackbed
