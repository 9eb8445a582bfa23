#pragma once

#include "trackbed/options/method_options.h"

namespace trackbed {

class SteeringController;

/// Stores the options of any registered controller. The type of the options struct that is stored
/// selects the controller.
using ControllerOptions = MethodOptions<SteeringController>;

/// Selects what a path-following controller assumes about the car's steering actuator.
enum class ActuatorKnowledge {
  kModel,   ///< The controller knows the actuator that the vehicle's parameters describe.
  kIgnore,  ///< The controller assumes an ideal actuator, without dead time, lag, backlash and
            ///< curve.
};

}  // namespace trackbed
