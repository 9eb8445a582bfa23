#pragma once

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the same initial state as InitialState(scenario), except for the steering angle on a
/// path from a file. On a path from a file, the wheels start at the steering angle that matches the
/// curvature of the first point, clamped to the car's limit. If the mission sets the steering
/// angle, the wheels start at this angle instead.
StartState InitialState(const Scenario& scenario, const VehicleParams& vehicle);

}  // namespace trackbed
