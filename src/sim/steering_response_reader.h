#pragma once

#include "src/sim/tyre_reader.h"
#include "trackbed/vehicle/steering_response.h"

namespace trackbed {

/// Reads the response of a steering actuator that turns the wheels by at most `limit` [rad] to each
/// side. Returns the ideal response (without delay) if the model does not describe a steering
/// response.
SteeringResponse ReadSteeringResponse(const Numerics& numerics, double limit);

}  // namespace trackbed
