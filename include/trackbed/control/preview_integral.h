#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// The weight W of the previewed path points in the integral.
enum class PreviewWeight {
  kUniform,  ///< Weight W = 1, equal for all previewed points.
  kNear,     ///< Weight W = 1 - eta/T, which decreases to 0 at the end T of the preview time eta.
};

/// MacAdam's optimal preview control (MacAdam 1981), with a driver delay. The controller commands
/// the constant steering angle that minimizes the lateral deviation over the whole previewed path.
///
/// Symbols: T = R/|v| preview time; R = max(distance, time |v|), lengthened for a car off its path
/// as in PreviewOptions. The default of the option `distance` is sqrt(g) times the default distance
/// of PreviewOptions with `delay` added to the response time; g is a ratio of gains. Without a
/// given `distance`, the controller follows curvature ramps instead of curvature steps, and turns
/// the wheels back early enough for their limited rate (PreviewOptions). The ratio g = 5/3 (5/2
/// with kNear) is the kinematic car's gain on an offset, divided by the gain of the controller with
/// a single preview point. For a car with tyre coefficients, a larger factor replaces sqrt(g) in
/// the preview distance. At this factor, the gain on an offset equals that of the controller with a
/// single preview point. Tyres respond late, so the preview law has a higher gain on an offset for
/// a car with tyres than for the kinematic car. With the smaller factor sqrt(g) on the preview
/// distance, a car with tyres and a limited steering rate would weave about its path for ever. The
/// variable eta in [0, T] is the time ahead. The following functions of the time ahead eta are
/// offsets across the direction of motion [m]: f(eta) is the offset of the path, y_0(eta) is the
/// offset of the car with straight wheels, and A(eta) is the displacement of the car per unit of
/// tan(delta). W(eta) is the weight of the path point at the time eta ahead. The commanded steering
/// angle delta minimizes the deviation f - y_0 - A tan(delta) of the car from the path, weighted by
/// W:
///   tan(delta) = int (f - y_0) A W d(eta) / int A^2 W d(eta).
/// A car without tyre coefficients is modeled as the kinematic car, with the offset functions y_0 =
/// 0 and A = (v eta)^2/(2 L), where L is the wheelbase. A car with tyre coefficients is modeled as
/// the linear single-track car with its present lateral speed and yaw rate. The offset f(eta) is
/// evaluated at the first point of the path at the distance v eta from the rear axle, as in
/// PreviewAngle. On a circle of radius r, the steering angle of a kinematic car with the wheelbase
/// L is exactly atan(L/r). For a car with tyre coefficients, the steering angle on a circle of
/// radius r includes the understeer, with an error of the order of (R/r)^2. If only the end of the
/// preview had weight, the controller would equal pure pursuit.
///
/// The integrals are computed by Gauss quadrature with ten points, which is exact for the kinematic
/// car. The commanded steering angle is delayed by `delay` [s], with linear interpolation between
/// control periods. The option `delay` models a driver's reaction time of about 0.2 s. The control
/// loop is only stable if the preview time is several times as long as the option `delay`.
///
/// On paths that are driven in reverse, the controller looks backwards along the path and models
/// the car as the kinematic car.
struct PreviewIntegralOptions {
  /// Shortest preview distance R [m], > 0; by default computed from the car and its speed.
  std::optional<double> distance;
  /// Minimum preview time [s], >= 0: the preview distance R is at least `time` times |v|.
  double time = 0.0;
  PreviewWeight weight = PreviewWeight::kUniform;
  double delay = 0.0;  ///< Delay tau of the driver's steering [s], >= 0.
};
void Visit(KeyVisitor& keys, PreviewIntegralOptions& options);

ControllerEntry PreviewIntegralController();

}  // namespace trackbed
