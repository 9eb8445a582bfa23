#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Pure pursuit (Coulter 1992) steers on the circle that is tangent to the rear axle's motion and
/// passes through a point of the path. The path point is at the look-ahead distance l =
/// max(distance, time |v|) from the rear axle. With the wheelbase L and the look-ahead distance l,
/// the steering angle is delta = atan(2 L sin(u)/l), with u the angle from the direction of motion
/// to the path point.
///
/// On a circle of radius R, the steering angle is exactly atan(L/R), with the wheelbase L. With
/// wheels that turn at most at the rate omega, a car with the wheelbase L and the speed v needs a
/// look-ahead distance l of about 1.5 cbrt(e L v/omega) to return from an offset e without
/// oscillation. By default, the look-ahead distance l is the largest of the preview distance R of
/// PreviewOptions, 1.5 cbrt(e L v/omega) and 3/4 L cbrt(v/(L omega)). The look-ahead distance 3/4 L
/// cbrt(v/(L omega)) is long enough to return from an offset of an eighth of the wheelbase L.
/// Unlike the preview controller, pure pursuit does not lengthen a given `distance` when the car is
/// off its path.
///
/// By default, the controller begins to turn the wheels back early enough for their limited rate
/// (src/control/timely_steering.h). Wheels that turn back too late would make the car overshoot on
/// a path that turns the wheels at nearly their full rate. If the option `distance` is given, the
/// controller uses the textbook law, without turning the wheels back early. Cost per control
/// period: the search for the look-ahead point tests up to 160 path points. The controller
/// allocates heap memory in its first control period only.
///
/// A look-ahead point may be behind the car, for example after a start that faces away from the
/// path. If the look-ahead point is behind the car, the car turns at full lock on the shorter side
/// (src/control/turn_round.h).
///
/// On paths that are driven in reverse, the circle passes through a path point behind the car.
/// Beyond the end of the path, the look-ahead point lies on the tangent at the end. Pure pursuit
/// ignores tyre slip, so an understeering car drives a wider circle than the path.
struct PurePursuitOptions {
  /// Shortest look-ahead distance l [m], > 0; by default computed from the car, its speed and the
  /// path.
  std::optional<double> distance;
  /// Minimum look-ahead time [s], >= 0: the look-ahead distance l is at least `time` times |v|.
  double time = 0.0;
};
void Visit(KeyVisitor& keys, PurePursuitOptions& options);

ControllerEntry PurePursuitController();

}  // namespace trackbed
