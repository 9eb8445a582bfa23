#pragma once

#include <optional>

#include "trackbed/control/signal.h"
#include "trackbed/options/key_visitor.h"

/// The options of the speed control (speed_controller.h).
namespace trackbed {

/// Braking that overrides every other speed command.
struct Braking {
  double at = 0.0;  ///< [s]; starts with the first control period that begins then or later
  double deceleration = 0.0;  ///< [m/s^2], >= 0, down to standstill; 0: the car coasts
};
void Visit(KeyVisitor& keys, Braking& braking);

struct SpeedControlOptions {
  double acceleration = 1.0;  ///< [m/s^2], > 0; also shapes the plan's speed profile
  double deceleration = 1.5;  ///< [m/s^2], > 0; also shapes the plan's speed profile
  double gain = 2.0;          ///< [1/s], on the speed error
  Signal over_time;           ///< speed [m/s] >= 0 over time [s]; empty: the profile's speed
  std::optional<Braking> braking;
};
void Visit(KeyVisitor& keys, SpeedControlOptions& options);

}  // namespace trackbed
