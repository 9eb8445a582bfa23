#pragma once

#include <memory>

#include "trackbed/sim/plant.h"

namespace trackbed {

/// `plant` behind the steering response of its car, unless that is ideal or the setup prescribes
/// the angle of the wheels.
std::unique_ptr<Plant> WithSteeringResponse(std::unique_ptr<Plant> plant, const PlantSetup& setup);

}  // namespace trackbed
