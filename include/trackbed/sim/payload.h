#pragma once

#include <optional>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/payload_options.h"

namespace trackbed {

/// Returns the car's scene with the payload added: a body `payload` fixed to `chassis`, and a
/// keyframe `laden` with the equilibrium pose. `car` must not have a payload yet, and its scene
/// must have flat ground and no obstacles. Throws InputError naming the car's file if the car does
/// not come to rest on its four wheels. The cost is that of a simulation in MuJoCo of at most a
/// second.
Scene WithPayload(const CarModel& car, const Payload& payload);

}  // namespace trackbed
