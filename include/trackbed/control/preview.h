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
  /// Steering angle delta = atan(2 L sin(u)/R) for the preview angle u and the wheelbase L, which
  /// steers on the circle through the preview point, as pure pursuit does.
  kExactArc,
};

/// MacAdam's preview control (MacAdam 1981) with a single preview point P. The preview point P lies
/// on the path, ahead of the path point nearest to the car. P is the first point of the path ahead
/// whose distance from the rear-axle center O is the preview distance R. The preview angle u is the
/// signed angle from the direction of motion to the line from O to P. Beyond the end of the path,
/// the preview point lies on the tangent at the end. If the car is farther than the preview
/// distance R from the path, the preview point is the path point whose station is R ahead of the
/// path point nearest to the car.
///
/// With a long preview distance R, the textbook law cuts corners; at the start of a circle of
/// radius r, the car drives R^2/(8 r) further inside. With a short preview distance, the control is
/// less robust to the limited steering rate. If the option `distance` is not given, the preview
/// distance R is computed from the wheelbase L, the speed v and the response time T:
///   R = max(3/4 L,  3 v T).
/// The response time T [s] is the sum of the control period, the steering lag, and the response
/// time m v/(C_f + C_r) of the tyres, which is 0 for a car without tyre coefficients. The other
/// symbols are L wheelbase [m], v speed [m/s], omega steering rate [rad/s], C_f, C_r cornering
/// stiffnesses of the axles [N/rad], and m mass [kg]. The page docs/algorithms/control.md has the
/// derivation and the sources.
///
/// Wheels with a limited rate cannot follow a step of the path's curvature. Without the option
/// `distance`, the preview point lies on a path whose curvature steps are replaced by ramps. A car
/// with a limited steering rate can drive the path with ramps. The path with curvature ramps leaves
/// the given path by at most kappa S^2/24, where kappa is the height of the curvature step and S
/// the distance driven while the wheels turn.
///
/// Without the option `distance`, the controller leaves out the turn toward the preview point that
/// a car on its path would make. The controller commands the curvature of the path instead, from
/// the place that the car reaches after the delays of the control period, the steering and the
/// tyres. A car on a path that its wheels can follow therefore stays on its path.
///
/// Without the option `distance`, the controller begins to turn the wheels back early enough for
/// their limited rate. The controller predicts the errors of the car after its wheels have turned
/// back, at their full rate, to the steering angle of the path. The preview law is applied to the
/// predicted errors of the car. On a straight path, the prediction of the errors changes the
/// steering angle only for large deviations of the car. Where the path itself turns the wheels at
/// their full rate, the prediction of the errors keeps the car from oscillating about the path. If
/// the option `distance` is given, the textbook preview law is applied to the path without
/// curvature ramps, and to the present errors of the car.
///
/// For a car at the speed v and an offset e from the path, the preview distance R is at least 1.5
/// cbrt(e L v/omega); with a shorter R, the car would oscillate about the path.
struct PreviewOptions {
  /// Shortest preview distance R [m], > 0; by default computed from the car and its speed.
  std::optional<double> distance;
  /// Minimum preview time [s]: the preview distance R is at least `time` times |v|.
  double time = 0.0;
  PreviewLaw law = PreviewLaw::kExactArc;
  /// Whether to account for tyre slip. If true, the commanded steering angle is that of the steady
  /// turn on tyres. The preview angle u is then measured from the direction in which the rear axle
  /// moves in the steady turn on the path. If slip is ignored, understeer reduces the gain of the
  /// preview law: a 1:10 car at 30 m/s then reaches only an eighth of the wanted curvature. The
  /// controller assumes no slip for a car whose rear axle has never moved sideways.
  bool slip = true;
};
void Visit(KeyVisitor& keys, PreviewOptions& options);

ControllerEntry PreviewController();

/// Returns the preview angle u [rad] of a car whose rear axle is at `pose`: the angle to the first
/// point of `path` beyond `station` that is `distance` [m] away. The preview angle is positive if
/// the previewed point lies to the left.
double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance);

}  // namespace trackbed
