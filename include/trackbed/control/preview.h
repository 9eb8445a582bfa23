#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// The law by which the preview controller computes the steering angle from the preview angle u.
enum class PreviewLaw {
  /// Steering angle delta = (2 L/R) u for the preview angle u, with MacAdam's gain for a single
  /// preview point and the kinematic car.
  kLinear,
  /// Steering angle delta = atan(2 L sin(u)/R), which steers on the circle through the preview
  /// point, as pure pursuit does.
  kExactArc,
};

/// MacAdam's preview control (MacAdam 1981) with a single preview point P. The preview point P lies
/// on the path, ahead of the path point nearest to the car. P is the first point of the path ahead
/// whose distance from the rear-axle center O is the preview distance R. The preview angle u is the
/// signed angle from the direction of motion to the line OP. Beyond the end of the path, the
/// preview point lies on the tangent at the end. If the car is farther than R from the path, the
/// preview point is the path point whose station is R ahead of the path point nearest to the car.
///
/// With a long preview distance R, the car cuts corners; on a circle of radius r, the car drives
/// R^2/(8 r) further inside. With a short preview distance, the control is less robust to the
/// limited steering rate. If the option `distance` is not given, R is computed from the car and its
/// speed:
///   R = max(3/4 L,  3 v T).
/// The response time T [s] is the sum of the control period, the steering lag, and the response
/// time m v/(C_f + C_r) of the tyres, which is 0 for a car without tyre coefficients. The other
/// symbols are L wheelbase [m], v speed [m/s], omega steering rate [rad/s], C_f, C_r cornering
/// stiffnesses of the axles [N/rad], and m mass [kg]. The page docs/algorithms/control.md has the
/// derivation and the sources.
///
/// Wheels with a limited rate cannot follow a step of the path's curvature. Without the option
/// `distance`, the preview point lies on a path whose curvature steps are replaced by ramps. A car
/// with a limited steering rate can drive the ramped path. The ramped path leaves the given path by
/// at most kappa S^2/24, where kappa is the height of the curvature step and S the distance driven
/// while the wheels turn.
///
/// Without the option `distance`, the wheels turn back early enough for their limited rate. The
/// controller predicts the errors of the car after its wheels have turned back, at their full rate,
/// to the steering angle of the path. The preview law is applied to the predicted errors. On a
/// straight path, the prediction changes the steering angle only for large deviations of the car.
/// Where the path itself turns the wheels at their full rate, the prediction keeps the car from
/// oscillating about the path. With a given `distance`, the textbook law is applied to the path
/// without ramps, and to the present errors of the car.
///
/// For a car at an offset e from the path, R is at least 1.5 cbrt(e L v/omega), because with a
/// shorter R, the car would oscillate about the path.
struct PreviewOptions {
  /// Shortest preview distance R [m], > 0; by default computed from the car and its speed.
  std::optional<double> distance;
  /// Minimum preview time [s]: the preview distance R is at least `time` times |v|.
  double time = 0.0;
  PreviewLaw law = PreviewLaw::kExactArc;
  /// Whether to account for tyre slip: if true, the steering angle is that of the steady turn on
  /// tyres, and the preview angle u is measured from the direction in which the rear axle moves in
  /// the steady turn on the path. Without slip, understeer reduces the gain of the law: a 1:10 car
  /// at 30 m/s then reaches an eighth of the wanted curvature. A car whose rear axle has never
  /// moved sideways has no slip.
  bool slip = true;
};
void Visit(KeyVisitor& keys, PreviewOptions& options);

ControllerEntry PreviewController();

/// Returns the preview angle u [rad] of a car whose rear axle is at `pose`: the angle to the first
/// point of `path` beyond `station` that is `distance` [m] away. The preview angle is positive if
/// the previewed point lies to the left.
double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance);

}  // namespace trackbed
