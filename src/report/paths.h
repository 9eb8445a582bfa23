#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/report/names.h"

namespace trackbed {

/// Returns the path and value of each leaf (number, text, ...) of the JSON document `json`, in
/// order. The path of a leaf has the form used in expectations and studies, such as
/// "turns[0].lateral_offset".
std::vector<std::pair<std::string, nlohmann::ordered_json>> LeafValues(
    const nlohmann::ordered_json& json);

/// Rounds a JSON number; returns any other JSON value unchanged.
nlohmann::ordered_json RoundedLeaf(const nlohmann::ordered_json& leaf);

/// Returns a table row for each value in an entry of metrics.json: {path, label, value, unit,
/// headline, limit}. The fields `unit`, `headline` and `limit` of a row are optional; `limit` is
/// {relation, bound}.
nlohmann::ordered_json NumbersJson(const nlohmann::ordered_json& entry,
                                   ShownName (*name_of)(const std::string& path));

}  // namespace trackbed
