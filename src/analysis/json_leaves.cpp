#include "src/analysis/json_leaves.h"

#include <fmt/format.h>

namespace trackbed {
namespace {

using nlohmann::ordered_json;
using Leaves = std::vector<std::pair<std::string, ordered_json>>;

void AddLeaves(const ordered_json& json, const std::string& path, Leaves& leaves) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      AddLeaves(value, path.empty() ? key : path + "." + key, leaves);
    }
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      AddLeaves(json[i], fmt::format("{}[{}]", path, i), leaves);
    }
  } else {
    leaves.emplace_back(path, json);
  }
}

}  // namespace

std::vector<std::pair<std::string, nlohmann::ordered_json>> LeavesOf(
    const nlohmann::ordered_json& json) {
  Leaves leaves;
  AddLeaves(json, "", leaves);
  return leaves;
}

}  // namespace trackbed
