#include "src/report/paths.h"

#include <fmt/format.h>

#include "src/report/numbers.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;
using Leaves = std::vector<std::pair<std::string, ordered_json>>;

void Gather(const ordered_json& json, const std::string& path, Leaves& leaves) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      Gather(value, path.empty() ? key : path + "." + key, leaves);
    }
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      Gather(json[i], fmt::format("{}[{}]", path, i), leaves);
    }
  } else {
    leaves.emplace_back(path, json);
  }
}

}  // namespace

Leaves LeafValues(const ordered_json& json) {
  Leaves leaves;
  Gather(json, "", leaves);
  return leaves;
}

ordered_json RoundedLeaf(const ordered_json& leaf) {
  return leaf.is_number_float() ? ordered_json(Rounded(leaf.get<double>())) : leaf;
}

ordered_json NumbersJson(const ordered_json& entry, ShownName (*name_of)(const std::string& path)) {
  ordered_json rows = ordered_json::array();
  for (const auto& [path, value] : LeafValues(entry)) {
    const ShownName name = name_of(path);
    rows.push_back({{"path", path}, {"label", name.label}, {"value", RoundedLeaf(value)}});
    if (!name.unit.empty()) {
      rows.back()["unit"] = name.unit;
    }
    if (name.headline) {
      rows.back()["headline"] = true;
    }
    if (name.limit) {
      const bool at_most = name.limit->relation == StandardLimit::Relation::kAtMost;
      rows.back()["limit"] = {{"relation", at_most ? "at_most" : "at_least"},
                              {"bound", name.limit->bound}};
    }
  }
  return rows;
}

}  // namespace trackbed
