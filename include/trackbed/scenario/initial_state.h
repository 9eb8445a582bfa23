#pragma once

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the initial state as InitialState(scenario) does, except for the steering on a path from
/// a file. On such a path, the wheels start at the steering angle for the curvature of the first
/// point, clamped to the car's limit, unless the mission sets the steering.
StartState InitialState(const Scenario& scenario, const VehicleParams& vehicle);

}  // namespace trackbed
