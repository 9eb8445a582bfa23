#pragma once

#include <optional>
#include <vector>

#include "trackbed/sim/payload.h"
#include "trackbed/vehicle/steering_faults.h"
#include "trackbed/world/wind.h"

/// What goes wrong on a drive: all that makes the car another than its controller's. Each is off
/// unless asked for. Wind and slippery road are the world's (world/world.h).
namespace trackbed {

/// From a moment or a place on the car is no faster than this, whatever is asked of it.
struct SpeedLoss {
  std::optional<double> from;     ///< [s]; this or
  std::optional<double> station;  ///< along the path, without one the distance driven [m];
                                  ///< neither: from the start
  double speed = 0.0;             ///< [m/s]
};

/// Standard deviations of what is measured, drawn anew at every control period, independent and
/// normal.
struct MeasurementNoise {
  double position = 0.0;  ///< of x and of y [m], >= 0
  double heading = 0.0;   ///< [rad], >= 0
};

/// What throws a car off sideways; positive to its left.
struct Kick {
  double at = 0.0;                     ///< [s]
  std::optional<double> displacement;  ///< at once [m]; this or
  std::optional<double> impulse;       ///< at the center of gravity [N s]
  std::optional<double> duration;      ///< of the impulse's constant force [s]; none: kKickDuration
};

inline constexpr double kKickDuration = 0.1;  // [s]

struct Disturbances {
  std::optional<SpeedLoss> speed_loss;
  double wheelbase = 1.0;  ///< what controllers take it for, in units of what it is
  SteeringFaults steering;
  MeasurementNoise noise;
  std::optional<Payload> payload;
  std::vector<Kick> kicks;
  double recovered_within = 0.05;  ///< of the path [m]
};

/// When the last disturbance is over that comes and goes, kick or gust, of those that are over by
/// `before` [s]. None when there is none.
std::optional<double> DisturbedUntil(const Disturbances& disturbances, const Wind& wind,
                                     double before);

}  // namespace trackbed
