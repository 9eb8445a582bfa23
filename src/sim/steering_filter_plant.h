#pragma once

#include <memory>

#include "trackbed/sim/plant.h"

namespace trackbed {

/// Wraps `plant` in a plant that applies the car's steering response to each command. Returns
/// `plant` unchanged if the steering response is ideal or the setup prescribes the wheel angle.
std::unique_ptr<Plant> WithSteeringResponse(std::unique_ptr<Plant> plant, const PlantSetup& setup);

}  // namespace trackbed
