#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/report/names.h"

namespace trackbed {

/// All values of `json` except sections and lists, in order. Paths are as in expectations and
/// studies: "turns[0].lateral_offset".
std::vector<std::pair<std::string, nlohmann::ordered_json>> LeafValues(
    const nlohmann::ordered_json& json);

/// Rounds numbers and returns other values unchanged.
nlohmann::ordered_json RoundedLeaf(const nlohmann::ordered_json& leaf);

/// Table rows for the values of an entry of metrics.json: {path, label, value, unit, headline,
/// limit}. The fields `unit`, `headline` and `limit` are optional; a limit is {relation, bound}.
nlohmann::ordered_json NumbersJson(const nlohmann::ordered_json& entry,
                                   ShownName (*name_of)(const std::string& path));

}  // namespace trackbed
