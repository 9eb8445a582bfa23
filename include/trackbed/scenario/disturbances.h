#pragma once

#include <optional>
#include <vector>

#include "trackbed/sim/payload_options.h"
#include "trackbed/vehicle/steering_faults.h"
#include "trackbed/world/wind.h"

/// Disturbances and faults of a run: differences between the car and the controller's model of it.
/// Each is off by default. Wind and friction patches are in world/world.h.
namespace trackbed {

/// Loss of speed: a speed limit from a time or station on, which overrides any commanded speed.
struct SpeedLoss {
  std::optional<double> from;  ///< [s]; either this or `station`
  std::optional<double>
      station;  ///< along the path, without one the distance traveled [m]; neither: from the start
  double speed = 0.0;  ///< [m/s]
};

/// Standard deviations of the measured pose: independent, Gaussian, white over control periods.
struct MeasurementNoise {
  double position = 0.0;  ///< of x and of y [m], >= 0
  double heading = 0.0;   ///< [rad], >= 0
};

/// A lateral kick, positive to the left.
struct Kick {
  double at = 0.0;                     ///< [s]
  std::optional<double> displacement;  ///< instantaneous [m]; either this or `impulse`
  std::optional<double> impulse;       ///< at the center of gravity [N s]
  std::optional<double> duration;      ///< of the impulse's constant force [s]; none: kKickDuration
};

inline constexpr double kKickDuration = 0.1;  // [s]

struct Disturbances {
  std::optional<SpeedLoss> speed_loss;
  double wheelbase = 1.0;  ///< ratio of the wheelbase assumed by controllers to the actual one
  SteeringFaults steering;
  MeasurementNoise noise;
  std::optional<Payload> payload;
  std::vector<Kick> kicks;
  double recovered_within = 0.05;  ///< of the path [m]
};

/// End of the last temporary disturbance, kick or gust, that ends by `before` [s]; nullopt without
/// one.
std::optional<double> DisturbedUntil(const Disturbances& disturbances, const Wind& wind,
                                     double before);

}  // namespace trackbed
