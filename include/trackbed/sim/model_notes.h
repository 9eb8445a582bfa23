#pragma once

#include <string>
#include <vector>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Returns notes on properties of a car's model that are allowed, but rarely intended. A tyre may
/// touch another part of the car in the configuration qpos0; this contact brakes the tyre or pushes
/// the car. An equality constraint may join a steered wheel to a joint other than `rack`; this
/// constraint works against the steering. For an ordinary car, the list of notes is empty.
/// NotesOnModel needs one collision detection of MuJoCo.
std::vector<std::string> NotesOnModel(const CarModel& car);

}  // namespace trackbed
