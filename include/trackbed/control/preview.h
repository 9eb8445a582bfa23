#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// How the preview controller turns the preview angle u into steering.
enum class PreviewLaw {
  /// delta = (2 L/R) u: MacAdam's gain for a single point and the kinematic car.
  kLinear,
  /// delta = atan(2 L sin(u)/R): steers on the circle through the preview point, as pure pursuit.
  kExactArc,
};

/// MacAdam's preview control (MacAdam 1981) with a single preview point P. P is the first point of
/// the path beyond the point nearest to the car that is at the distance R from the rear-axle center
/// O. The preview angle u is the signed angle from the direction of motion to OP. Beyond its end,
/// the path continues along its tangent. If the car is farther than R from the path, the preview
/// point is R ahead of the path point nearest to the car.
///
/// With a long preview distance R, the car cuts corners: on a circle of radius r by R^2/(8 r). A
/// short preview distance is less robust to the limited steering rate. Unless `distance` is given,
/// R follows from the car, its speed and the path:
///   R = max(3/4 L,  3 v T,  0.65 S + v T)
///   T [s]  response time: control period + steering lag + m v/(C_f + C_r), the tyres' part 0 for a
///          car without tyre coefficients
///   S [m]  distance by which rate-limited steering lags behind the path: the largest
///          v abs(delta(s_2) - delta(s_1))/omega - (s_2 - s_1) of any two
///          stations s_1 < s_2 within R, with delta = atan(L kappa) of the path
/// with L wheelbase [m], v speed [m/s], omega steering rate [rad/s], C_f, C_r cornering stiffness
/// of the axles [N/rad], m mass [kg]. Relative to the size of car and path, the tracking error
/// depends only on v/(L omega) and v T/L. Derivation and sources: docs/algorithms/control.md.
///
/// The formula for R suits a car on its path. For a car at an offset e from the path, this R would
/// require a higher steering rate than the car has, and the car would oscillate about the path.
/// Therefore R is at least 1.5 cbrt(e L v/omega).
struct PreviewOptions {
  std::optional<double> distance;  ///< Shortest preview distance R [m], > 0; computed from car,
                                   ///< speed and path by default.
  double time = 0.0;               ///< Lower bound on the preview distance R as a time [s]: R is at
                                   ///< least time |v|.
  PreviewLaw law = PreviewLaw::kExactArc;
  /// Whether to account for tyre slip: u is measured from the actual direction of motion of the
  /// rear axle, and the steering includes understeer. At 20 m/s, the loop is stable with a preview
  /// distance of 0.5 s of driving, and unstable with 0.3 s.
  bool slip = false;
};
void Visit(KeyVisitor& keys, PreviewOptions& options);

ControllerEntry PreviewController();

/// Returns the preview angle u [rad] of a car whose rear axle is at `pose`: the angle to the first
/// point of `path` beyond `station` that is `distance` [m] away. The angle is positive if the point
/// lies to the left.
double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance);

}  // namespace trackbed
