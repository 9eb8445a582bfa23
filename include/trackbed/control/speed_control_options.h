#pragma once

#include <optional>

#include "trackbed/control/signal.h"
#include "trackbed/options/key_visitor.h"

/// Options of the speed control, which speed_controller.h implements.
namespace trackbed {

/// Braking that overrides every other speed command.
struct Braking {
  /// Time at which the braking begins [s], rounded up to the next control period.
  double at = 0.0;
  /// Deceleration of the car until standstill [m/s^2], >= 0. With 0, the car coasts.
  double deceleration = 0.0;
};
void Visit(KeyVisitor& keys, Braking& braking);

struct SpeedControlOptions {
  double acceleration = 1.0;  ///< Maximum acceleration [m/s^2], > 0; also limits the plan's speed
                              ///< profile.
  double deceleration = 1.5;  ///< Maximum deceleration of the plan's speed profile [m/s^2], > 0;
                              ///< see SpeedControl.
  double gain = 2.0;          ///< Gain on the speed error [1/s].
  Signal over_time;           ///< Wanted speed [m/s] >= 0 over time [s]; if empty, the car follows
                              ///< the plan's speed profile.
  std::optional<Braking> braking;
};
void Visit(KeyVisitor& keys, SpeedControlOptions& options);

}  // namespace trackbed
