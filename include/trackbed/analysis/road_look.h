#pragma once

#include <optional>
#include <string>

#include "trackbed/world/world.h"

namespace trackbed {

/// Returns the road that pictures show along a plan of the named planner: the world's road if the
/// world has a road. In a world without a road, planners that neither avoid obstacles nor meet
/// headings get a default road, because these planners are made for roads and courses, not for
/// parking lots and fields. Returns nullopt if the road's width is 0. Also returns nullopt in a
/// world with a road network but without a road, because the roads of the network are drawn.
std::optional<RoadLook> RoadToDraw(const World& world, const std::string& planner);

}  // namespace trackbed
