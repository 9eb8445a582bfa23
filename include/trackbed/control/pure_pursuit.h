#pragma once

#include <memory>

namespace trackbed {

class SteeringController;

/// Pure pursuit (Coulter 1992): the circle tangent to the rear axle's motion through the path's
/// point at the distance l = max(distance, time |v|), delta = atan(2 L sin(u)/l) with u the angle
/// from the direction of motion to that point.
///
/// On a circle it steers atan(L/R) exactly. A fixed distance is a fixed fraction of the car's
/// response in space, so at higher speeds it has to grow: with the wheels' rate omega limited, a
/// car at speed v needs l of about 1.5 cbrt(e L v/omega) to return from an offset e without
/// swinging out. PreviewOptions lengthens its distance for that; this law does not.
///
/// Reverse paths: the point lies behind, the same circle. Beyond its end the path goes on along its
/// tangent. Knows no slip: a car that understeers runs outside of its circle.
struct PurePursuitOptions {
  double distance = 4.0;  ///< shortest l [m], > 0
  double time = 0.8;      ///< [s], >= 0
};

std::unique_ptr<SteeringController> MakePurePursuit(const PurePursuitOptions& options);

}  // namespace trackbed
