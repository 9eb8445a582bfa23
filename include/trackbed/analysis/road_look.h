#pragma once

#include <optional>
#include <string>

#include "trackbed/world/world.h"

namespace trackbed {

/// The road that pictures show along a plan of the named planner: the world's road if it has one.
/// Else a default road, but only for planners that neither avoid obstacles nor meet headings: they
/// are made for roads and courses rather than parking lots and fields. None if the width is 0, and
/// by default in a world with a road network, which draws its roads.
std::optional<RoadLook> RoadToDraw(const World& world, const std::string& planner);

}  // namespace trackbed
