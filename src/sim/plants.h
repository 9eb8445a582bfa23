#pragma once

#include "trackbed/sim/plant.h"

namespace trackbed {

// Plants whose actuators get each command as it is, at once: see steering_filter_plant.h.

std::unique_ptr<Plant> MakeIdealKinematicPlant(const PlantSetup& setup, ReferencePoint reference);

/// InputError naming what the car's file lacks when it says nothing of its tyres.
std::unique_ptr<Plant> MakeSingleTrackPlant(const PlantSetup& setup);

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup);

}  // namespace trackbed
