#pragma once

#include "trackbed/options/method_options.h"

namespace trackbed {

class SteeringController;

/// Stores the options of any registered controller. The type of the options struct that is stored
/// selects the controller.
using ControllerOptions = MethodOptions<SteeringController>;

/// Selects what a path-following controller assumes about the car's steering actuator.
enum class ActuatorKnowledge {
  kModel,   ///< The controller uses the actuator model of the vehicle's parameters.
  kIgnore,  ///< The controller assumes an ideal actuator, without dead time, lag, backlash and
            ///< calibration curve.
};

}  // namespace trackbed
