#pragma once

#include <optional>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/payload_options.h"

namespace trackbed {

/// Adds the payload to the car: a body `payload` fixed to `chassis`, and a keyframe `laden` with
/// the equilibrium pose. `car` must have no payload. The car's scene must have flat ground and no
/// obstacles. InputError naming the car's file if the car does not come to rest on its four wheels.
/// Cost: at most a second of simulated time in MuJoCo.
Scene WithPayload(const CarModel& car, const Payload& payload);

}  // namespace trackbed
