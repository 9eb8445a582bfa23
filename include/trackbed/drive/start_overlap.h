#pragma once

#include <string>

#include "trackbed/scenario/scenario.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Returns why the scenario's car cannot be at its start, for people: names the first obstacle or
/// wall of the map that overlaps the car's footprint at time 0, and the depth of the overlap, which
/// is the length of the shortest translation that separates them [m]. Returns an empty text if
/// nothing overlaps the footprint; an obstacle may touch it. Obstacles that are not known at the
/// start count, too, because the physics simulation knows them.
std::string StartOverlap(const Scenario& scenario, const VehicleParams& vehicle);

}  // namespace trackbed
