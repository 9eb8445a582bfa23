#pragma once

#include <optional>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/payload_options.h"

namespace trackbed {

/// Puts the payload into the car: a body `payload` fixed to `chassis`, and a keyframe `laden`, the
/// laden equilibrium pose. `car` must have no payload, and its scene flat ground without obstacles.
/// InputError naming the car's file when it does not come to rest on its four wheels. Cost: a
/// second of MuJoCo's time at most.
Scene WithPayload(const CarModel& car, const Payload& payload);

}  // namespace trackbed
