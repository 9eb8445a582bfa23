#pragma once

#include <optional>
#include <string>

#include "trackbed/world/world.h"

namespace trackbed {

/// The road that pictures show along a plan of the planner of that name: the world's own; without
/// one, the default along plans that neither avoid obstacles nor meet headings, which are made for
/// roads and courses, and not for parking lots and fields. None where the width is 0, and by
/// default in a world with a road network, which has roads of its own.
std::optional<RoadLook> RoadToDraw(const World& world, const std::string& planner);

}  // namespace trackbed
