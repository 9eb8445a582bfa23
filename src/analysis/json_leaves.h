#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

/// Every value of `json` that is no section or list, with its path: "turns[0].lateral_offset".
std::vector<std::pair<std::string, nlohmann::ordered_json>> LeavesOf(
    const nlohmann::ordered_json& json);

}  // namespace trackbed
