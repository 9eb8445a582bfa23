#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Weighting of the previewed path.
enum class PreviewWeight {
  kUniform,  ///< W = 1: equal weight of all points.
  kNear,     ///< W = 1 - eta/T: decreases to 0 at the end of the preview.
};

/// MacAdam's optimal preview control (MacAdam 1981): the constant steering angle that minimizes the
/// lateral deviation over the whole previewed path, with a driver delay.
///
/// Symbols: T = R/|v| preview time; R = max(distance, time |v|), lengthened for a car off its path
/// as in PreviewOptions. By default, `distance` is sqrt(g) times the default distance of
/// PreviewOptions, computed with `delay` added to the response time. The factor g = 5/3 (5/2 with
/// kNear) is the gain on an offset relative to that of a single preview point. eta in [0, T] is the
/// time ahead. Offsets across the direction of motion [m]: f(eta) offset of the path; y_0(eta)
/// offset of the car with straight wheels; A(eta) displacement of the car per unit of tan(delta).
/// W(eta) is the weight of the time eta.
///   tan(delta) = int (f - y_0) A W d(eta) / int A^2 W d(eta)
/// A car without tyre coefficients is modeled as kinematic: y_0 = 0, A = (v eta)^2/(2 L). A car
/// with tyre coefficients is modeled as the linear single-track car with its present lateral speed
/// and yaw rate. f(eta) is evaluated at the path's first point at the distance v eta from the rear
/// axle, as in PreviewAngle. On a circle of radius r, the law therefore gives atan(L/r), exactly
/// for a kinematic car. For a car with tyre coefficients, the angle includes the understeer, with
/// an error of the order of (R/r)^2. If only the end of the preview had weight, the law would be
/// pure pursuit.
///
/// The integrals use Gauss quadrature with ten points, which is exact for the kinematic car. The
/// steering angle is delayed by `delay` [s], interpolated linearly between control periods. The
/// delay models a driver's reaction time of about 0.2 s. The loop is only stable if the preview
/// time is several times as long as the delay.
///
/// On reverse paths, the law looks backwards along the path and models the car as kinematic.
struct PreviewIntegralOptions {
  std::optional<double> distance;  ///< Shortest preview distance R [m], > 0; computed from car,
                                   ///< speed and path by default.
  double time = 0.0;               ///< Lower bound on the preview distance R as a time [s], >= 0.
  PreviewWeight weight = PreviewWeight::kUniform;
  double delay = 0.0;  ///< Driver delay tau [s], >= 0.
};
void Visit(KeyVisitor& keys, PreviewIntegralOptions& options);

ControllerEntry PreviewIntegralController();

}  // namespace trackbed
