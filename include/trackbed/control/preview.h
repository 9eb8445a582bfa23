#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// The law by which the preview controller computes the steering angle from the preview angle u.
enum class PreviewLaw {
  /// Steering angle delta = (2 L/R) u, with MacAdam's gain for a single preview point and the
  /// kinematic car.
  kLinear,
  /// Steering angle delta = atan(2 L sin(u)/R), which steers on the circle through the preview
  /// point, as pure pursuit does.
  kExactArc,
};

/// MacAdam's preview control (MacAdam 1981) with a single preview point P. The preview point P lies
/// on the path, ahead of the path point nearest to the car. P is the first point of this part of
/// the path whose distance from the rear-axle center O is R. The preview angle u is the signed
/// angle from the direction of motion to the line OP. Beyond the end of the path, the preview point
/// lies on the tangent at the end. If the car is farther than R from the path, the preview point is
/// the path point whose station is R ahead of the path point nearest to the car.
///
/// With a long preview distance R, the car cuts corners; on a circle of radius r, the car drives
/// R^2/(8 r) further inside. With a short preview distance, the control is less robust to the
/// limited steering rate. If the option `distance` is not given, R is computed from the car, its
/// speed and the path:
///   R = max(3/4 L,  3 v T,  0.65 S + v T).
/// The response time T [s] is the sum of the control period, the steering lag, and the response
/// time of the tyres. The latter is m v/(C_f + C_r), or 0 for a car without tyre coefficients. S
/// [m] is the distance by which the rate-limited steering lags behind the path. S is the largest
/// value of v abs(delta(s_2) - delta(s_1))/omega - (s_2 - s_1) for any two stations s_1 < s_2
/// within R, with delta = atan(L kappa) of the path. The other symbols are L wheelbase [m], v speed
/// [m/s], omega steering rate [rad/s], C_f, C_r cornering stiffnesses of the axles [N/rad], and m
/// mass [kg]. Relative to the size of car and path, the tracking error depends only on v/(L omega)
/// and v T/L. The page docs/algorithms/control.md has the derivation and the sources.
///
/// The formula for the preview distance R suits a car on its path. For a car at an offset e from
/// the path, a distance R from the formula would require a higher steering rate than the car has.
/// The car would then oscillate about the path. To avoid such oscillations, R is at least 1.5
/// cbrt(e L v/omega).
struct PreviewOptions {
  /// Shortest preview distance R [m], > 0; by default computed from the car, its speed and the
  /// path.
  std::optional<double> distance;
  /// Minimum preview time [s]: the preview distance R is at least `time` times |v|.
  double time = 0.0;
  PreviewLaw law = PreviewLaw::kExactArc;
  /// Whether to account for tyre slip. If true, the steering angle is that of the steady turn on
  /// tyres. The preview angle u is then measured from the direction in which the rear axle moves in
  /// this turn. Without slip, understeer reduces the gain of the law: a 1:10 car at 30 m/s then
  /// reaches an eighth of the wanted curvature. A car whose rear axle has never moved sideways has
  /// no slip.
  bool slip = true;
};
void Visit(KeyVisitor& keys, PreviewOptions& options);

ControllerEntry PreviewController();

/// Returns the preview angle u [rad] of a car whose rear axle is at `pose`: the angle to the first
/// point of `path` beyond `station` that is `distance` [m] away. The preview angle is positive if
/// the previewed point lies to the left.
double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance);

}  // namespace trackbed
