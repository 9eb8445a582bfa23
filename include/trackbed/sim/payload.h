#pragma once

#include <optional>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// A payload: a point mass on the chassis, in addition to the model. Axes are the car's: x forward
/// from the rear axle, y to the left, z up from the ground.
struct Payload {
  std::optional<double> mass;   ///< [kg], > 0; this or
  std::optional<double> share;  ///< of the car's own mass, > 0
  double x = 0.0;               ///< [m]; 0: over the rear axle
  double y = 0.0;               ///< [m]
  std::optional<double> z;      ///< [m]; none: as high as the car's own center of gravity
};

/// Puts the payload into the car: a body `payload` fixed to `chassis`, and a keyframe `laden`, the
/// laden equilibrium pose. `car` must have no payload, and its scene flat ground without obstacles.
/// InputError naming the car's file when it does not come to rest on its four wheels. Cost: a
/// second of MuJoCo's time at most.
Scene WithPayload(const CarModel& car, const Payload& payload);

}  // namespace trackbed
