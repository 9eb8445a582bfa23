#pragma once

#include <optional>
#include <string>

#include "trackbed/world/world.h"

namespace trackbed {

/// Returns the road that frames and pictures show along a plan of the named planner. If the world
/// has a road, returns this road. If the world has no road, a default road is returned for planners
/// that neither avoid obstacles nor reach given headings. Planners that neither avoid obstacles nor
/// reach given headings are made for roads and courses, not for parking lots and fields. Returns
/// nullopt if the width of the road is 0. Also returns nullopt if the world has a road network but
/// no road, because the roads of the network are drawn instead.
std::optional<RoadLook> RoadToDraw(const World& world, const std::string& planner);

}  // namespace trackbed
