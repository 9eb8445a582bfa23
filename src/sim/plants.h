#pragma once

#include "trackbed/sim/plant.h"

namespace trackbed {

// The actuators of these plants follow each command at once; see steering_filter_plant.h for
// delays.

std::unique_ptr<Plant> MakeIdealKinematicPlant(const PlantSetup& setup, ReferencePoint reference);

/// InputError naming the missing coefficients if the car's file has no tyres.
std::unique_ptr<Plant> MakeSingleTrackPlant(const PlantSetup& setup);

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup);

}  // namespace trackbed
