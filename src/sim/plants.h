#pragma once

#include "trackbed/sim/plant.h"

namespace trackbed {

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup);

}  // namespace trackbed
