#include "src/report/checks.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "src/report/paths.h"
#include "trackbed/report/names.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

/// Formats the bound of a check as text, such as "≤ 0.15" or "= arrived".
std::string BoundText(const std::string& relation, const ordered_json& bound) {
  const char* sign = relation == "at_most" ? "≤" : relation == "at_least" ? "≥" : "=";
  // The bound of the check is rounded to six significant digits, like the metrics on the page.
  return fmt::format("{} {}", sign,
                     bound.is_number_float() ? fmt::format("{:.6g}", bound.get<double>())
                     : bound.is_string()     ? bound.get<std::string>()
                                             : bound.dump());
}

/// Returns the label of a temporal-logic requirement, such as "Robustness of lane: always
/// abs(cross_track_m) < 0.5". In the label of a requirement, a long formula is shortened.
std::string RequirementLabel(const ShownName& name, const std::string& formula) {
  constexpr std::size_t kMaxFormulaLength = 120;
  return fmt::format("{}: {}{}", name.label, formula.substr(0, kMaxFormulaLength),
                     formula.size() > kMaxFormulaLength ? " …" : "");
}

}  // namespace

ordered_json CheckRows(const JsonValue& verdict) {
  ordered_json rows = ordered_json::array();
  const std::optional<JsonValue> checks = verdict.Find("checks");
  for (const JsonValue& check : checks ? checks->Elements() : std::vector<JsonValue>()) {
    const std::string plant = check.At("plant").Text();
    const std::string metric = check.At("metric").Text();
    const bool is_pair = plant.find(" – ") != std::string::npos;
    const ShownName name = is_pair ? NameOfComparison(metric) : NameOfMetric(metric);
    const std::optional<JsonValue> formula = check.Find("formula");
    const std::string relation = check.At("relation").Text();
    const ordered_json bound = check.At("bound").Scalar();
    rows.push_back({{"of", plant},
                    {"metric", metric},
                    {"what", formula ? RequirementLabel(name, formula->Text()) : name.label},
                    {"unit", name.unit},
                    {"relation", relation},
                    {"bound", RoundedLeaf(bound)},
                    {"asked", BoundText(relation, bound)},
                    {"found", RoundedLeaf(check.At("value").Scalar())},
                    {"t", RoundedLeaf(check.At("time").Scalar())},
                    {"met", check.At("met").Flag()}});
  }
  return rows;
}

ordered_json VerdictJson(const JsonValue& verdict) {
  const JsonValue passed = verdict.At("passed");
  ordered_json shown{{"passed", nullptr}};
  if (!passed.IsNull()) {
    shown["passed"] = passed.Flag();
  }
  for (const char* list : {"failures", "notes"}) {
    shown[list] = verdict.At(list).Texts();
  }
  return shown;
}

}  // namespace trackbed
