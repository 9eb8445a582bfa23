#pragma once

#include "trackbed/options/method_options.h"

namespace trackbed {

class SteeringController;

/// The options of any registered controller. The type of the stored struct selects the controller.
using ControllerOptions = MethodOptions<SteeringController>;

}  // namespace trackbed
