#include "src/report/checks.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "src/report/names.h"
#include "src/report/paths.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

/// "≤ 0.15", "= arrived".
std::string AskedText(const ordered_json& check) {
  const std::string relation = check.at("relation").get<std::string>();
  const ordered_json& bound = check.at("bound");
  const char* sign = relation == "at_most" ? "≤" : relation == "at_least" ? "≥" : "=";
  // Ten digits: what was typed, and not the rounding of what was computed.
  return fmt::format("{} {}", sign,
                     bound.is_number_float() ? fmt::format("{:.10g}", bound.get<double>())
                     : bound.is_string()     ? bound.get<std::string>()
                                             : bound.dump());
}

}  // namespace

ordered_json CheckRows(const ordered_json& verdict) {
  ordered_json rows = ordered_json::array();
  for (const ordered_json& check : verdict.value("checks", ordered_json::array())) {
    const std::string plant = check.at("plant").get<std::string>();
    const std::string metric = check.at("metric").get<std::string>();
    const bool is_pair = plant.find(" – ") != std::string::npos;
    const ShownName name = is_pair ? NameOfComparison(metric) : NameOfMetric(metric);
    rows.push_back({{"of", plant},
                    {"what", name.label},
                    {"unit", name.unit},
                    {"asked", AskedText(check)},
                    {"found", RoundedLeaf(check.at("value"))},
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
