#pragma once

#include "trackbed/control/optimal_steering.h"

namespace trackbed {

/// Returns the registry entry of the controller `optimal_steering`.
ControllerEntry OptimalSteering();

}  // namespace trackbed
