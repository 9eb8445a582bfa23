#pragma once

#include <memory>

#include "trackbed/sim/plant.h"

namespace trackbed {

/// Wraps `plant` in the steering response of its car, unless the response is ideal or the setup
/// prescribes the wheel angle.
std::unique_ptr<Plant> WithSteeringResponse(std::unique_ptr<Plant> plant, const PlantSetup& setup);

}  // namespace trackbed
