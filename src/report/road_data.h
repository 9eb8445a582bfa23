#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace trackbed {

/// Returns the pavement and road marks of the road network in a run folder, for the map and the 3D
/// replay. Each entry of `bands` (pavement) has its edges `left` and `right`; each entry of `lines`
/// (road marks) has `points`, `width` and `yellow`. Each list of points contains x, y, x, y, ...
/// [m].
nlohmann::ordered_json RoadsJson(const std::filesystem::path& folder);

}  // namespace trackbed
