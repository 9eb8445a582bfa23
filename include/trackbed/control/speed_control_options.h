#pragma once

#include <optional>

#include "trackbed/control/signal.h"
#include "trackbed/options/key_visitor.h"

/// The options of the speed control (speed_controller.h).
namespace trackbed {

/// Braking that overrides every other speed command.
struct Braking {
  /// Time at which the braking begins [s], rounded up to the next control period.
  double at = 0.0;
  /// Deceleration down to standstill [m/s^2], >= 0; 0: the car coasts.
  double deceleration = 0.0;
};
void Visit(KeyVisitor& keys, Braking& braking);

struct SpeedControlOptions {
  double acceleration = 1.0;  ///< Acceleration [m/s^2], > 0; also shapes the plan's speed profile.
  double deceleration = 1.5;  ///< Deceleration [m/s^2], > 0; also shapes the plan's speed profile.
  double gain = 2.0;          ///< Gain on the speed error [1/s].
  Signal over_time;           ///< Speed [m/s] >= 0 over time [s]; empty: the profile's speed.
  std::optional<Braking> braking;
};
void Visit(KeyVisitor& keys, SpeedControlOptions& options);

}  // namespace trackbed
