#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

/// Every value of `json` that is no section or list, in order, with its path as expectations and
/// studies write it: "turns[0].lateral_offset".
std::vector<std::pair<std::string, nlohmann::ordered_json>> LeafValues(
    const nlohmann::ordered_json& json);

/// Numbers rounded, all else as it is.
nlohmann::ordered_json RoundedLeaf(const nlohmann::ordered_json& leaf);

}  // namespace trackbed
