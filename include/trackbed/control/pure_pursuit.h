#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Pure pursuit (Coulter 1992) steers on the circle that is tangent to the rear axle's motion and
/// passes through a point of the path. The point is at the distance l = max(distance, time |v|).
/// The steering angle is delta = atan(2 L sin(u)/l), with u the angle from the direction of motion
/// to the point.
///
/// On a circle of radius R, the steering angle is exactly atan(L/R). If the wheels' rate omega is
/// limited, a car at speed v needs l of about 1.5 cbrt(e L v/omega) to return from an offset e
/// without oscillation. Unlike PreviewOptions, this law does not lengthen l for the car's offset.
/// By default, l is the distance of PreviewOptions, and at least 3/4 L cbrt(v/(L omega)), enough
/// for an offset of an eighth of the wheelbase.
///
/// On reverse paths, the circle passes through a point behind the car. Beyond its end the path
/// continues along its tangent. The law ignores slip: an understeering car drives outside of its
/// circle.
struct PurePursuitOptions {
  std::optional<double> distance;  ///< Shortest l [m], > 0; by default the distance given above.
  double time = 0.0;  ///< Lower bound on l as a time [s], >= 0: l is at least time |v|.
};
void Visit(KeyVisitor& keys, PurePursuitOptions& options);

ControllerEntry PurePursuitController();

}  // namespace trackbed
