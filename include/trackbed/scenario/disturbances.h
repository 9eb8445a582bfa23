#pragma once

#include <optional>
#include <vector>

#include "trackbed/sim/payload_options.h"
#include "trackbed/vehicle/steering_faults.h"
#include "trackbed/world/wind.h"

/// Disturbances and faults of a run: differences between the car and the controller's model of it.
/// Each disturbance is off by default. Wind and friction patches are in world/world.h.
namespace trackbed {

/// Loss of speed: a speed limit from a time or station on. The limit overrides any commanded speed.
struct SpeedLoss {
  std::optional<double> from;  ///< Start time [s]; excludes `station`.
  /// Start station on the path, or without a path the distance traveled [m]. Without `from` and
  /// `station`, the limit applies from the start.
  std::optional<double> station;
  double speed = 0.0;  ///< Speed limit [m/s].
};

/// Standard deviations of the noise of the measured pose. The noise is independent, Gaussian, and
/// white over control periods.
struct MeasurementNoise {
  double position = 0.0;  ///< Deviation of x and of y [m], >= 0.
  double heading = 0.0;   ///< Deviation of the heading [rad], >= 0.
};

/// A lateral kick, positive to the left.
struct Kick {
  double at = 0.0;                     ///< Time of the kick [s].
  std::optional<double> displacement;  ///< Instantaneous displacement [m]; excludes `impulse`.
  std::optional<double> impulse;       ///< Impulse at the center of gravity [N s].
  /// Duration of the impulse's constant force [s]; none: kKickDuration.
  std::optional<double> duration;
};

inline constexpr double kKickDuration = 0.1;  // Default duration [s].

struct Disturbances {
  std::optional<SpeedLoss> speed_loss;
  double wheelbase = 1.0;  ///< Ratio of the wheelbase that controllers assume to the actual one.
  SteeringFaults steering;
  MeasurementNoise noise;
  std::optional<Payload> payload;
  std::vector<Kick> kicks;
  /// Distance from the path within which the car has recovered [m].
  double recovered_within = 0.05;
};

/// End of the last temporary disturbance, kick or gust, that ends by `before` [s]; nullopt if there
/// is none.
std::optional<double> DisturbedUntil(const Disturbances& disturbances, const Wind& wind,
                                     double before);

}  // namespace trackbed
