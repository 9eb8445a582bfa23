#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Weighting of the previewed path.
enum class PreviewWeight {
  kUniform,  ///< W = 1
  kNear,     ///< W = 1 - eta/T: decreases to 0 at the end of the preview
};

/// MacAdam's optimal preview control (MacAdam 1981): the constant steering angle that minimizes the
/// lateral deviation over the whole previewed path, with a driver delay.
///
/// Symbols: T = R/|v| the preview time, R = max(distance, time |v|), and never shorter than a car
/// off its path needs to swing back (PreviewOptions). Unless `distance` is given it is that of
/// PreviewOptions, with `delay` as a part of the response time, times sqrt(g): g = 5/3 (5/2 with
/// kNear) is the gain of this law on an offset relative to a single preview point. eta time ahead
/// in [0, T]; f(eta) where the path is, y_0(eta) where the car comes with straight wheels, A(eta)
/// how far one unit of tan(delta) moves it, all across the direction of motion [m]; W(eta) the
/// weight.
///   tan(delta) = int (f - y_0) A W d(eta) / int A^2 W d(eta)
/// A car without tyre coefficients is kinematic: y_0 = 0, A = (v eta)^2/(2 L); one with them is the
/// linear single-track car with its present lateral speed and yaw rate. f(eta) is taken at the
/// path's first point at the distance v eta of the rear axle, as PreviewAngle finds it. So the law
/// gives atan(L/r) on a circle of radius r, for a kinematic car exactly, for one with tyres with
/// its understeer and to the order of (R/r)^2; with all weight at the end it is pure pursuit.
///
/// The integrals are Gauss's with ten points: exact for the kinematic car. `delay` holds the angle
/// back, between two control periods by linear interpolation: a driver's reaction time, of about
/// 0.2 s, for which the loop is stable only with a preview of several times that.
///
/// Reverse paths are previewed backwards, kinematically.
struct PreviewIntegralOptions {
  std::optional<double> distance;  ///< shortest R [m], > 0; default: the law above
  double time = 0.0;               ///< [s], >= 0
  PreviewWeight weight = PreviewWeight::kUniform;
  double delay = 0.0;  ///< tau [s], >= 0
};
void Visit(KeyVisitor& keys, PreviewIntegralOptions& options);

ControllerEntry PreviewIntegralController();

}  // namespace trackbed
