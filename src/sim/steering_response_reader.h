#pragma once

#include "src/sim/tyre_reader.h"
#include "trackbed/vehicle/steering_response.h"

namespace trackbed {

/// The response of a steering actuator that turns the wheels by up to `limit` [rad] to both sides.
/// The response is ideal if the model does not describe it.
SteeringResponse ReadSteeringResponse(const Numerics& numerics, double limit);

}  // namespace trackbed
