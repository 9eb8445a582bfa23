#pragma once

#include <string>
#include <vector>

#include "src/road_network/lane_graph.h"

namespace trackbed {

/// Returns the links from the end of a lane that lead to missing or broken parts of the network.
/// Each link is described by a text for error messages.
std::vector<std::string> BrokenExits(const RoadNetwork& network, const LaneNode& node);

}  // namespace trackbed
