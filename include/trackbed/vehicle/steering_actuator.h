#pragma once

namespace trackbed {

/// A steering actuator that moves the road wheels at a limited rate within limited angles.
struct SteeringLimits {
  double angle = 0.0;  ///< Largest angle to both sides [rad], > 0.
  double rate = 0.0;   ///< Largest rate in both directions [rad/s], > 0.
};

/// A move of the steering angle from `start` toward a commanded angle, which is clipped to the
/// limits. The angle moves at the full rate for `ramp_time`, then stays constant at `end`.
struct SteeringMove {
  double start = 0.0;      ///< Initial angle [rad].
  double end = 0.0;        ///< Final angle [rad].
  double rate = 0.0;       ///< Signed rate during the ramp [rad/s].
  double ramp_time = 0.0;  ///< Duration of the ramp [s].

  /// The exact angle after `time` [rad].
  [[nodiscard]] double At(double time) const {
    return time < ramp_time ? start + rate * time : end;
  }
};

SteeringMove MoveSteering(const SteeringLimits& limits, double start, double wanted);

}  // namespace trackbed
