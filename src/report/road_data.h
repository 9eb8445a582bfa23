#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace trackbed {

/// Pavement and paint of a run folder's road network, for map and replay. Each of `bands` has
/// `left` and `right`; each of `lines` has `points`, `width` and `yellow`. Points are listed as x,
/// y, x, y, ... [m].
nlohmann::ordered_json RoadsJson(const std::filesystem::path& folder);

}  // namespace trackbed
