#pragma once

#include <optional>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/payload_options.h"

namespace trackbed {

/// Returns the car's scene with the payload added. The payload is a body `payload` that is fixed to
/// `chassis`, and a keyframe `laden` contains the equilibrium position of the car with payload.
/// The argument `car` must not have a payload yet, and its scene must have flat ground and no
/// obstacles. Throws InputError naming the car's file if the car does not come to rest on its four
/// wheels. WithPayload simulates the car in MuJoCo for at most one second of simulated time.
Scene WithPayload(const CarModel& car, const Payload& payload);

}  // namespace trackbed
