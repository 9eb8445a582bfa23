#pragma once

#include <array>

#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

namespace trackbed {

/// Part of a time step in which the steering angle and the speed are linear in time and the speed
/// keeps its sign.
struct MotionPiece {
  double duration = 0.0;       ///< Duration of the motion piece [s]; 0 if the piece is empty.
  double steering_rate = 0.0;  ///< Steering rate [rad/s].
  double acceleration = 0.0;   ///< Acceleration of the car during the piece [m/s^2].
  /// Steering angle at the end of the piece [rad], stored exactly so that rounding errors do not
  /// accumulate.
  double end_steering = 0.0;
  /// Speed at the end of the piece [m/s], stored exactly; 0 if the car comes to rest.
  double end_speed = 0.0;
};

/// Steering angle and speed of a car during a time step with a constant command, as a sequence of
/// exact pieces. A new motion piece begins when the steering reaches its target and when the car
/// comes to rest.
struct Motion {
  std::array<MotionPiece, 3> pieces;
  double steering_rate = 0.0;  ///< Steering rate of the last motion piece [rad/s].
  double acceleration = 0.0;   ///< Acceleration of the last motion piece [m/s^2].
};

Motion MotionUnder(const Command& command, const VehicleParams& params, double steering,
                   double speed, double duration);

}  // namespace trackbed
