#pragma once

#include "trackbed/sim/plant.h"

namespace trackbed {

// The actuators of a planar plant follow each command at once. For actuators with delays see
// steering_filter_plant.h.

std::unique_ptr<Plant> MakeIdealKinematicPlant(const PlantSetup& setup, ReferencePoint reference);

/// Throws InputError naming the missing coefficients if the car's file has no tyres.
std::unique_ptr<Plant> MakeSingleTrackPlant(const PlantSetup& setup);

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup);

}  // namespace trackbed
