#include "trackbed/analysis/margins.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace trackbed {
namespace {

std::optional<double> NumberOfValue(const MetricValue& value) {
  const nlohmann::ordered_json json = ToJson(value);
  return json.is_number() ? std::optional(json.get<double>()) : std::nullopt;
}

/// Returns the bound of a check as a number. If the bound is a text, as is possible with
/// Relation::kEquals, NumberOfBound parses the text as a number.
std::optional<double> NumberOfBound(const MetricValue& bound) {
  const auto* text = std::get_if<std::string>(&bound);
  if (text == nullptr) {
    return NumberOfValue(bound);
  }
  const auto parsed = nlohmann::json::parse(*text, nullptr, false);
  return parsed.is_number() ? std::optional(parsed.get<double>()) : std::nullopt;
}

std::optional<double> Clearance(const RunResult& result, const std::string& plant) {
  for (const PlantMetrics& metrics : result.metrics) {
    if (metrics.plant == plant && metrics.clearance) {
      return metrics.clearance->collision ? 0.0 : metrics.clearance->min;
    }
  }
  return std::nullopt;
}

std::optional<double> MarginOf(const Check& check) {
  const std::optional<double> bound = NumberOfBound(check.bound);
  const std::optional<double> value = NumberOfValue(check.value);
  if (!bound || !value) {
    return std::nullopt;
  }
  switch (check.relation) {
    case Relation::kAtMost:
      return *bound - *value;
    case Relation::kAtLeast:
      return *value - *bound;
    case Relation::kEquals:
      return -std::abs(*value - *bound);
  }
  return std::nullopt;
}

}  // namespace

std::vector<ExpectationMargin> Margins(const RunResult& result) {
  std::vector<ExpectationMargin> margins;
  for (const Check& check : result.verdict.checks) {
    const std::string plant = PlantsOf(check);
    ExpectationMargin margin{.name = fmt::format("{} {}", plant, check.metric),
                             .plant = plant,
                             .margin = MarginOf(check),
                             .unit = check.unit,
                             .met = check.met,
                             .at = check.at};
    if (check.metric == "collision") {
      // If the scenario expects a collision, the margin is the negative clearance.
      const std::optional<double> clearance = Clearance(result, check.plant);
      const double sign = check.bound == MetricValue(std::string("true")) ? -1.0 : 1.0;
      margin.margin = clearance ? std::optional(sign * *clearance) : std::nullopt;
      margin.unit = "m";
    }
    margins.push_back(std::move(margin));
  }
  return margins;
}

}  // namespace trackbed
