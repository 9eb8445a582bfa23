#pragma once

#include "trackbed/sim/plant.h"

namespace trackbed {

std::unique_ptr<Plant> MakeMujocoPlant(const CarModel& car, const World& world,
                                       const StartState& start);

}  // namespace trackbed
