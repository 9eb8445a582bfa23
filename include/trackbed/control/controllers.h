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

/// Returns the registry entry of the controller that `options` select. Throws InternalError for
/// empty options.
const ControllerEntry& ControllerFor(const ControllerOptions& options);

/// Makes the controller that `options` select. The controller's Steer throws InternalError for a
/// state with NaN or infinity. Throws PreconditionError for option values outside their documented
/// ranges.
std::unique_ptr<SteeringController> MakeSteeringController(const ControllerOptions& options);

}  // namespace trackbed
