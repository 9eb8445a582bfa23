#pragma once

#include "trackbed/sim/plant.h"

namespace trackbed {

/// InputError naming what the car's file lacks when it says nothing of its tyres.
std::unique_ptr<Plant> MakeSingleTrackPlant(const PlantSetup& setup);

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup);

}  // namespace trackbed
