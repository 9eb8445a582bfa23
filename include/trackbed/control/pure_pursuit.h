#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Pure pursuit (Coulter 1992): the circle tangent to the rear axle's motion through the path's
/// point at the distance l = max(distance, time |v|), delta = atan(2 L sin(u)/l) with u the angle
/// from the direction of motion to that point.
///
/// On a circle of radius R it steers atan(L/R) exactly. If the wheels' rate omega is limited, a car
/// at speed v needs l of about 1.5 cbrt(e L v/omega) to return from an offset e without
/// oscillation. Unlike PreviewOptions, this law does not lengthen l for the car's offset. Unless
/// `distance` is given, l is the distance of PreviewOptions, and at least 3/4 L cbrt(v/(L omega)),
/// enough for an offset of an eighth of the wheelbase.
///
/// On reverse paths, the circle passes through a point behind the car. Beyond its end the path
/// continues along its tangent. Ignores slip: an understeering car runs outside of its circle.
struct PurePursuitOptions {
  std::optional<double> distance;  ///< shortest l [m], > 0; default: the law above
  double time = 0.0;               ///< l is at least time |v| [s], >= 0
};
void Visit(KeyVisitor& keys, PurePursuitOptions& options);

ControllerEntry PurePursuitController();

}  // namespace trackbed
