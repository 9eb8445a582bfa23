#pragma once

#include <string>

#include "trackbed/scenario/scenario.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Explains to the user why the scenario's car cannot be at its start. The returned text names the
/// first obstacle or wall of the map that overlaps the car's footprint at time 0, and the depth of
/// the overlap [m]. The depth is the length of the shortest translation that separates obstacle and
/// footprint. Returns an empty text if nothing overlaps the footprint; an obstacle may touch the
/// footprint. The overlap test includes obstacles that the car does not know at the start, because
/// the physics simulation contains all obstacles.
std::string StartOverlap(const Scenario& scenario, const VehicleParams& vehicle);

}  // namespace trackbed
