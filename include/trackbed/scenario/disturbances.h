#pragma once

#include <optional>
#include <vector>

#include "trackbed/sim/payload_options.h"
#include "trackbed/vehicle/steering_faults.h"
#include "trackbed/world/wind.h"

/// Disturbances and faults of a run: differences between the car and the controller's model of the
/// car. Each disturbance is off by default. Wind and friction patches are in world/world.h.
namespace trackbed {

/// A loss of speed: a speed limit that applies from a time or station on. The limit overrides any
/// commanded speed.
struct SpeedLoss {
  std::optional<double> from;  ///< Start time [s]; cannot be combined with `station`.
  /// Start station on the path [m]; without a path, the distance traveled. Without `from` and
  /// `station`, the limit applies from the start.
  std::optional<double> station;
  double speed = 0.0;  ///< Speed limit [m/s].
};

/// Standard deviations of the noise on the measured pose. The noise is independent, Gaussian, and
/// white over control periods.
struct MeasurementNoise {
  double position = 0.0;  ///< Standard deviation of x and of y [m], >= 0.
  double heading = 0.0;   ///< Standard deviation of the heading [rad], >= 0.
};

/// A lateral kick, positive to the left.
struct Kick {
  double at = 0.0;  ///< Time of the kick [s].
  /// Instantaneous displacement [m]; cannot be combined with `impulse`.
  std::optional<double> displacement;
  std::optional<double> impulse;  ///< Impulse at the center of gravity [N s].
  /// Duration of the constant force that produces the impulse [s]; default: kKickDuration.
  std::optional<double> duration;
};

inline constexpr double kKickDuration = 0.1;  // Default duration of an impulse [s].

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

/// Returns the end of the last temporary disturbance (kick or gust) that ends no later than
/// `before` [s]; nullopt if no disturbance does.
std::optional<double> DisturbedUntil(const Disturbances& disturbances, const Wind& wind,
                                     double before);

}  // namespace trackbed
