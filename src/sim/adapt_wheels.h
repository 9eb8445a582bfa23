#pragma once

#include <string>
#include <vector>

#include "src/sim/adapt_find.h"

namespace trackbed::adapt {

/// Finds the wheels of all vehicles of a model, without their steering joints and springs. These
/// are hinge joints with a nearly horizontal axis and a round geom about this axis, and round geoms
/// that have no hinge. Wheels whose lowest point is above the ground are dropped.
std::vector<FoundWheel> FindWheels(const FoundModel& found, const AdaptOptions& options);

/// Describes why the hinges of the model are no wheels, and which meshes are missing.
std::string WhyNoWheels(const FoundModel& found);

}  // namespace trackbed::adapt
