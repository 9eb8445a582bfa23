#pragma once

#include "trackbed/options/method_options.h"

namespace trackbed {

class SteeringController;

/// Stores the options of any registered controller. The type of the options struct that is stored
/// selects the controller.
using ControllerOptions = MethodOptions<SteeringController>;

}  // namespace trackbed
