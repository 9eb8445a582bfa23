#pragma once

#include <memory>
#include <vector>

#include "trackbed/control/steering_controller.h"

/// The registry of steering controllers.
namespace trackbed {

/// All steering controllers, the built-in ones first.
const std::vector<ControllerEntry>& Controllers();

/// Adds a controller to the registry, for scenarios, `trackbed list`, messages and reports. Call
/// RegisterController at the start of main: it invalidates references to entries and is not
/// thread-safe. PreconditionError when the name or the type of the options is taken.
void RegisterController(ControllerEntry entry);

/// The entry of the controller that has these options. InternalError for empty options.
const ControllerEntry& ControllerFor(const ControllerOptions& options);

/// Makes the controller that `options` select. The controller's Steer throws InternalError for a
/// state with NaN or infinity. PreconditionError for options out of their keys' ranges.
std::unique_ptr<SteeringController> MakeSteeringController(const ControllerOptions& options);

}  // namespace trackbed
