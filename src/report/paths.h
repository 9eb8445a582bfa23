#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/report/names.h"

namespace trackbed {

/// Every value of `json` that is no section or list, in order, with its path as expectations and
/// studies write it: "turns[0].lateral_offset".
std::vector<std::pair<std::string, nlohmann::ordered_json>> LeafValues(
    const nlohmann::ordered_json& json);

/// Numbers rounded, all else as it is.
nlohmann::ordered_json RoundedLeaf(const nlohmann::ordered_json& leaf);

/// Every value of an entry of metrics.json as a row of a table: {path, label, value, unit,
/// headline, limit}, the last three where there are such; a limit is {relation, bound}.
nlohmann::ordered_json NumbersJson(const nlohmann::ordered_json& entry,
                                   ShownName (*name_of)(const std::string& path));

}  // namespace trackbed
