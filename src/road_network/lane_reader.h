#pragma once

#include <string>
#include <vector>

#include "src/road_network/road_reader.h"

namespace trackbed {

/// Reads the lane sections of a road from the elements <laneSection> of <lanes>. Adds the lane
/// height definitions that Trackbed ignores to `unread_heights`.
std::vector<LaneSection> ReadLaneSections(const XmlFields& lanes, const Road& road,
                                          std::vector<std::string>& unread_heights);

}  // namespace trackbed
