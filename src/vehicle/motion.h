#pragma once

#include <array>

#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

namespace trackbed {

/// A part of a step in which steering and speed both run along straight lines, and the speed keeps
/// its sign.
struct MotionPiece {
  double duration = 0.0;       ///< [s]; 0: there is no such part
  double steering_rate = 0.0;  ///< [rad/s]
  double acceleration = 0.0;   ///< [m/s^2]
  double end_steering = 0.0;   ///< [rad]; exact, so that rounding does not build up
  double end_speed = 0.0;      ///< [m/s]; likewise, 0 where the car comes to rest
};

/// How steering and speed of a car that obeys exactly run under a constant command: cut where the
/// steering arrives and where the car comes to rest.
struct Motion {
  std::array<MotionPiece, 3> pieces;
  double steering_rate = 0.0;  ///< that led to the end [rad/s]
  double acceleration = 0.0;   ///< likewise [m/s^2]
};

Motion MotionUnder(const Command& command, const VehicleParams& params, double steering,
                   double speed, double duration);

}  // namespace trackbed
