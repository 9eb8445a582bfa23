#pragma once

#include <memory>
#include <vector>

#include "trackbed/control/steering_controller.h"

/// The registry of steering controllers.
namespace trackbed {

/// Returns all registered steering controllers, the built-in controllers first.
const std::vector<ControllerEntry>& Controllers();

/// Adds a controller to the registry, so that scenarios, `trackbed list`, messages and reports can
/// use the controller. Call RegisterController at the start of main, because RegisterController is
/// not thread-safe and invalidates references to registry entries. Throws PreconditionError if
/// another controller has the same name or the same type of options.
void RegisterController(ControllerEntry entry);

/// Returns the registry entry of the controller to which `options` belong. Throws InternalError if
/// `options` is empty.
const ControllerEntry& ControllerFor(const ControllerOptions& options);

/// Makes the steering controller whose options struct is in `options`. The function Steer of the
/// returned controller throws InternalError if the car's state contains NaN or infinity.
/// MakeSteeringController throws PreconditionError if an option value is outside of its documented
/// range. A path-following controller with feedback accounts for the car's steering actuator as
/// `actuator` selects (docs/algorithms/control.md).
std::unique_ptr<SteeringController> MakeSteeringController(
    const ControllerOptions& options, ActuatorKnowledge actuator = ActuatorKnowledge::kModel);

}  // namespace trackbed
