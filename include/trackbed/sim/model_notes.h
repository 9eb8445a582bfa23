#pragma once

#include <string>
#include <vector>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Returns notes on properties of a car's model that are allowed, but rarely intended. Tyres may
/// touch the car itself in the configuration qpos0, which brakes them or pushes the car. Equality
/// constraints may join a steered wheel to a joint other than `rack`, which works against the
/// steering. Returns no notes for an ordinary car. Cost: one collision detection of MuJoCo.
std::vector<std::string> NotesOnModel(const CarModel& car);

}  // namespace trackbed
