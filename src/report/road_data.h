#pragma once

#include <nlohmann/json.hpp>

#include "trackbed/road_network/road_network.h"
#include "trackbed/road_network/road_paint.h"

namespace trackbed {

/// Returns the pavement and road marks of a road network, for the map and the 3D
/// replay. Each entry of `bands` (pavement) has its edges `left` and `right`; each entry of `lines`
/// (road marks) has `points`, `width` and `yellow`. Each list of points contains x, y, x, y, ...
/// [m].
nlohmann::ordered_json RoadsJson(const RoadNetwork& network);
nlohmann::ordered_json RoadsJson(const RoadPaint& paint);

}  // namespace trackbed
