#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace trackbed {

/// Pavement and paint of a run folder's road network, for map and replay: `bands`, each with `left`
/// and `right`, and `lines`, each with `points`, `width` and `yellow`. Points are x, y, x, y, ...
/// [m].
nlohmann::ordered_json RoadsJson(const std::filesystem::path& folder);

}  // namespace trackbed
