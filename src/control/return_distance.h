#pragma once

#include <algorithm>
#include <cmath>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Below this speed previews no longer shrink with it [m/s].
inline constexpr double kCrawl = 0.5;

/// The shortest preview [m] that the steering rate can act on, for a car at `speed` that is
/// `offset` [m] beside its path: on wheels that turn at their full rate the curvature changes by
/// c = omega/(L v) per metre, and swinging back over an offset e takes a way in proportion to
/// cbrt(e/c).
inline double ReturnDistance(const VehicleParams& vehicle, double speed, double offset) {
  // Found by trial on offsets of 0.2 to 4 m with previews of 2 to 4 m: all return to the path with
  // it; with 1 some swing on for ever, with 2 they return more slowly.
  constexpr double kShare = 1.5;
  const double curvature_rate =
      vehicle.steering_rate / (vehicle.wheelbase * std::max(std::abs(speed), kCrawl));
  return kShare * std::cbrt(std::abs(offset) / curvature_rate);
}

/// Of the car where it is now.
inline double ReturnDistance(const ControlInput& input) {
  const Vec2 foot = input.reference.path.At(input.station).pose.position();
  const double offset = (input.state.pose.position() - foot).norm();
  return ReturnDistance(input.vehicle, input.state.speed, offset);
}

}  // namespace trackbed
