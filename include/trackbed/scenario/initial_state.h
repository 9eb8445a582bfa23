#pragma once

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// As InitialState without vehicle, except on a path from a file. On a path from a file, the wheels
/// start at the angle of the path's first point, within the car's limit, unless the mission sets
/// the steering.
StartState InitialState(const Scenario& scenario, const VehicleParams& vehicle);

}  // namespace trackbed
