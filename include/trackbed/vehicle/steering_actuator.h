#pragma once

namespace trackbed {

/// A steering actuator that moves the road wheels at a limited rate within limited angles.
struct SteeringLimits {
  double angle = 0.0;  ///< [rad], > 0, to both sides
  double rate = 0.0;   ///< [rad/s], > 0, in both directions
};

/// The angle from `start` toward `wanted` (clipped to the limits): at the full rate for
/// `ramp_time`, then constant at `end`.
struct SteeringMove {
  double start = 0.0;      ///< [rad]
  double end = 0.0;        ///< final angle [rad]
  double rate = 0.0;       ///< signed rate while it moves [rad/s]
  double ramp_time = 0.0;  ///< [s]

  /// The angle after `time` [rad]; exact.
  [[nodiscard]] double At(double time) const {
    return time < ramp_time ? start + rate * time : end;
  }
};

SteeringMove MoveSteering(const SteeringLimits& limits, double start, double wanted);

}  // namespace trackbed
