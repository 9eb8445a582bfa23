#pragma once

#include "trackbed/sim/plant.h"

namespace trackbed {

// The actuators of planar plants follow each command immediately. The wrapper in
// steering_filter_plant.h adds the car's steering response to a planar plant.

std::unique_ptr<Plant> MakeIdealKinematicPlant(const PlantSetup& setup);

/// Throws InputError naming the missing coefficients if the car's file has no tyres.
std::unique_ptr<Plant> MakeSingleTrackPlant(const PlantSetup& setup);

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup);

/// Makes the MuJoCo plant of a car with steered front wheels, or of a vehicle with differential
/// drive.
std::unique_ptr<Plant> MakeCarPlant(const PlantSetup& setup);

std::unique_ptr<Plant> MakeWheelPairPlant(const PlantSetup& setup);

}  // namespace trackbed
