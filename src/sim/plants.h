#pragma once

#include "trackbed/sim/plant.h"

namespace trackbed {

// In planar plants, the actuators follow each command immediately. Delays are added in
// steering_filter_plant.h.

std::unique_ptr<Plant> MakeIdealKinematicPlant(const PlantSetup& setup, ReferencePoint reference);

/// Throws InputError naming the missing coefficients if the car's file has no tyres.
std::unique_ptr<Plant> MakeSingleTrackPlant(const PlantSetup& setup);

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup);

}  // namespace trackbed
