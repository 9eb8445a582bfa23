#pragma once

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// The initial state of the car of a scenario once the car is known: as InitialState, but on a path
/// in a file with the wheels turned as its first point asks, within the car's limit, unless the
/// mission gives the steering.
StartState InitialState(const Scenario& scenario, const VehicleParams& vehicle);

}  // namespace trackbed
