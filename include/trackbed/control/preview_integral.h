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
/// as in PreviewOptions. By default, `distance` is that of PreviewOptions with `delay` added to the
/// response time, times sqrt(g). The factor g = 5/3 (5/2 with kNear) is the gain on an offset
/// relative to that of a single preview point. eta in [0, T] is the time ahead. Offsets across the
/// direction of motion [m]: f(eta) offset of the path; y_0(eta) offset of the car with straight
/// wheels; A(eta) displacement of the car per unit of tan(delta). W(eta) weight.
///   tan(delta) = int (f - y_0) A W d(eta) / int A^2 W d(eta)
/// A car without tyre coefficients is kinematic: y_0 = 0, A = (v eta)^2/(2 L). A car with tyre
/// coefficients is the linear single-track car with its present lateral speed and yaw rate. f(eta)
/// is evaluated at the path's first point at the distance v eta from the rear axle, as in
/// PreviewAngle. On a circle of radius r, the law therefore gives atan(L/r), exactly for a
/// kinematic car. For a car with tyres, understeer is added, to the order of (R/r)^2. With all
/// weight at the end of the preview, the law is pure pursuit.
///
/// The integrals use Gauss quadrature with ten points, exact for the kinematic car. The steering
/// angle is delayed by `delay` [s], interpolated linearly between control periods. The delay models
/// a driver's reaction time of about 0.2 s. The loop is only stable if the preview time is several
/// times as long.
///
/// Reverse paths are previewed backwards, with the kinematic car.
struct PreviewIntegralOptions {
  std::optional<double> distance;  ///< Shortest R [m], > 0; by default the distance given above.
  double time = 0.0;               ///< Lower bound on R as a time [s], >= 0.
  PreviewWeight weight = PreviewWeight::kUniform;
  double delay = 0.0;  ///< Driver delay tau [s], >= 0.
};
void Visit(KeyVisitor& keys, PreviewIntegralOptions& options);

ControllerEntry PreviewIntegralController();

}  // namespace trackbed
