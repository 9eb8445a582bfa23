#pragma once

#include <string>
#include <vector>

#include "src/sim/adapt_find.h"

namespace trackbed::adapt {

/// Finds the wheels of all vehicles of a model, without their steering joints and springs. A wheel
/// is either a hinge joint with a nearly horizontal axis and a round geom about this axis, or a
/// round geom without a hinge. FindWheels drops wheels whose lowest point is above the ground.
std::vector<FoundWheel> FindWheels(const FoundModel& found, const AdaptOptions& options);

/// Returns a text for the user that explains why the hinges of the model are not wheels, and names
/// missing meshes.
std::string WhyNoWheels(const FoundModel& found);

}  // namespace trackbed::adapt
