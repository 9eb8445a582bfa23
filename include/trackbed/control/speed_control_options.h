#pragma once

#include <optional>

#include "trackbed/control/signal.h"
#include "trackbed/options/key_visitor.h"

/// Options of the speed control, which is implemented in speed_controller.h.
namespace trackbed {

/// Braking that overrides every other speed command.
struct Braking {
  /// Time at which the braking begins [s], rounded up to the next control period.
  double at = 0.0;
  /// Deceleration of the car until standstill [m/s^2], >= 0. If the deceleration is 0, the car
  /// coasts.
  double deceleration = 0.0;
};
void Visit(KeyVisitor& keys, Braking& braking);

struct SpeedControlOptions {
  /// Maximum acceleration of the car and of the plan's speed profile [m/s^2], > 0.
  double acceleration = 1.0;
  /// Maximum deceleration of the plan's speed profile [m/s^2], > 0; SpeedControl may brake harder.
  double deceleration = 1.5;
  double gain = 2.0;  ///< Gain of the speed control on the speed error [1/s].
  /// Wanted speed of the car [m/s], >= 0, as a function of time [s]; if empty, the car follows the
  /// plan's speed profile.
  Signal over_time;
  std::optional<Braking> braking;
};
void Visit(KeyVisitor& keys, SpeedControlOptions& options);

}  // namespace trackbed
