#pragma once

#include <optional>
#include <string>

#include "trackbed/world/world.h"

namespace trackbed {

/// The road that pictures show along a plan of the named planner: the world's road if it has one.
/// Without one, a default road, but only for planners that neither avoid obstacles nor meet
/// headings. Planners of that kind are made for roads and courses, not for parking lots and fields.
/// Nullopt if the width is 0. By default also nullopt in a world with a road network, which draws
/// its own roads.
std::optional<RoadLook> RoadToDraw(const World& world, const std::string& planner);

}  // namespace trackbed
