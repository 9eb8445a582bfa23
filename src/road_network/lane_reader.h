#pragma once

#include <string>
#include <vector>

#include "src/road_network/road_reader.h"

namespace trackbed {

/// Reads the lane sections of a road from the elements <laneSection> of <lanes>. Adds to
/// `unread_heights` the definitions of heights that Trackbed ignores.
std::vector<LaneSection> ReadLaneSections(const XmlFields& lanes, const Road& road,
                                          std::vector<std::string>& unread_heights);

}  // namespace trackbed
