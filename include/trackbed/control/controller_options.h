#pragma once

#include "trackbed/options/method_options.h"

namespace trackbed {

class SteeringController;

/// The options of a controller. The type of the contained struct identifies the controller.
using ControllerOptions = MethodOptions<SteeringController>;

}  // namespace trackbed
