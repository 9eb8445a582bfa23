#include "src/report/checks.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "src/report/paths.h"
#include "trackbed/report/names.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

/// "≤ 0.15", "= arrived".
std::string AskedText(const ordered_json& check) {
  const std::string relation = check.at("relation").get<std::string>();
  const ordered_json& bound = check.at("bound");
  const char* sign = relation == "at_most" ? "≤" : relation == "at_least" ? "≥" : "=";
  // Six digits, as metrics are shown: what was computed is known no better.
  return fmt::format("{} {}", sign,
                     bound.is_number_float() ? fmt::format("{:.6g}", bound.get<double>())
                     : bound.is_string()     ? bound.get<std::string>()
                                             : bound.dump());
}

/// "Robustness of lane: always abs(cross_track_m) < 0.5", shortened.
std::string RequirementLabel(const ShownName& name, const std::string& formula) {
  constexpr std::size_t kLongest = 120;
  return fmt::format("{}: {}{}", name.label, formula.substr(0, kLongest),
                     formula.size() > kLongest ? " …" : "");
}

}  // namespace

ordered_json CheckRows(const ordered_json& verdict) {
  ordered_json rows = ordered_json::array();
  for (const ordered_json& check : verdict.value("checks", ordered_json::array())) {
    const std::string plant = check.at("plant").get<std::string>();
    const std::string metric = check.at("metric").get<std::string>();
    const bool is_pair = plant.find(" – ") != std::string::npos;
    const ShownName name = is_pair ? NameOfComparison(metric) : NameOfMetric(metric);
    const std::string formula = check.value("formula", "");
    rows.push_back({{"of", plant},
                    {"metric", metric},
                    {"what", formula.empty() ? name.label : RequirementLabel(name, formula)},
                    {"unit", name.unit},
                    {"relation", check.at("relation")},
                    {"bound", RoundedLeaf(check.at("bound"))},
                    {"asked", AskedText(check)},
                    {"found", RoundedLeaf(check.at("value"))},
                    {"t", RoundedLeaf(check.at("time"))},
                    {"met", check.at("met").get<bool>()}});
  }
  return rows;
}

ordered_json VerdictJson(const ordered_json& verdict) {
  const ordered_json& passed = verdict.at("passed");
  ordered_json shown{{"passed", nullptr}};
  if (!passed.is_null()) {
    shown["passed"] = passed.get<bool>();
  }
  for (const char* list : {"failures", "notes"}) {
    shown[list] = verdict.at(list).get<std::vector<std::string>>();
  }
  return shown;
}

}  // namespace trackbed
