#pragma once

namespace trackbed {

/// A steering actuator that turns the road wheels at a limited rate within a limited range of
/// angles.
struct SteeringLimits {
  double angle = 0.0;  ///< Largest steering angle to either side [rad], > 0.
  double rate = 0.0;   ///< Largest steering rate in either direction [rad/s], > 0.
};

/// A motion of the steering angle from `start` toward a commanded angle, which is first clipped to
/// the actuator's limits. The steering angle changes at the full rate for `ramp_time`, and then
/// stays constant at `end`.
struct SteeringMove {
  double start = 0.0;      ///< Initial angle [rad].
  double end = 0.0;        ///< Final angle [rad].
  double rate = 0.0;       ///< Signed steering rate during the ramp [rad/s].
  double ramp_time = 0.0;  ///< Duration of the change of the steering angle [s].

  /// Returns the exact steering angle [rad] after `time` [s].
  [[nodiscard]] double At(double time) const {
    return time < ramp_time ? start + rate * time : end;
  }
};

SteeringMove MoveSteering(const SteeringLimits& limits, double start, double wanted);

}  // namespace trackbed
