#pragma once

#include <optional>
#include <vector>

#include "trackbed/sim/payload_options.h"
#include "trackbed/vehicle/steering_faults.h"
#include "trackbed/world/wind.h"

/// Disturbances and faults of a run: differences between the simulated car and the controller's
/// model of the car. By default, a run has no disturbances. Wind and friction patches are in
/// world/world.h.
namespace trackbed {

/// A loss of speed: a speed limit that applies from a given time or station on. The speed limit
/// overrides any commanded speed.
struct SpeedLoss {
  /// Time from which the speed limit applies [s]; cannot be combined with `station`.
  std::optional<double> from;
  /// Station on the path from which the speed limit applies [m]; without a path, the traveled
  /// distance. If neither `from` nor `station` is set, the speed limit applies from the start of
  /// the run.
  std::optional<double> station;
  double speed = 0.0;  ///< Speed limit [m/s].
};

/// Standard deviations of the noise on the measured pose. The noise is Gaussian, and independent
/// for each component of the pose and for each control period.
struct MeasurementNoise {
  double position = 0.0;  ///< Standard deviation of the noise on the measured x and y [m], >= 0.
  double heading = 0.0;   ///< Standard deviation of the noise on the heading [rad], >= 0.
};

/// A sudden lateral displacement of the car or impulse on the car, positive to the left.
struct Kick {
  double at = 0.0;  ///< Time at which the kick starts [s].
  /// Instantaneous lateral displacement of the car [m]; cannot be combined with `impulse`.
  std::optional<double> displacement;
  std::optional<double> impulse;  ///< Lateral impulse at the car's center of gravity [N s].
  /// Duration of the constant force that produces the impulse [s]; default: kKickDuration.
  std::optional<double> duration;
};

// Default duration of the force that produces an impulse [s].
inline constexpr double kKickDuration = 0.1;

struct Disturbances {
  std::optional<SpeedLoss> speed_loss;
  /// Ratio of the wheelbase that controllers assume to the actual wheelbase.
  double wheelbase = 1.0;
  SteeringFaults steering;
  MeasurementNoise noise;
  std::optional<Payload> payload;
  std::vector<Kick> kicks;
  /// Maximum distance from the path at which the car counts as recovered from a disturbance [m].
  double recovered_within = 0.05;
};

/// Returns the end time of the last temporary disturbance (kick or gust) that ends at or before
/// `before` [s]. Returns nullopt if no temporary disturbance ends by that time.
std::optional<double> DisturbedUntil(const Disturbances& disturbances, const Wind& wind,
                                     double before);

}  // namespace trackbed
