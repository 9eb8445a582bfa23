#include "src/analysis/metric_expectations.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/analysis/json_leaves.h"
#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

/// Whether a value is what a scenario wrote.
bool Equals(const nlohmann::ordered_json& value, const std::string& expected) {
  if (value.is_string()) {
    return value.get<std::string>() == expected;
  }
  const auto parsed = nlohmann::ordered_json::parse(expected, nullptr, false);
  return !parsed.is_discarded() && parsed == value;
}

}  // namespace

void JudgeMetrics(const std::vector<MetricExpectation>& expectations, const PlantMetrics& metrics,
                  Verdict& verdict) {
  if (expectations.empty()) {
    return;
  }
  const auto leaves = LeavesOf(ToJson(metrics));
  const auto fail = [&](std::string message) {
    verdict.failures.push_back(metrics.plant + ": " + std::move(message));
  };
  for (const MetricExpectation& expect : expectations) {
    const auto found = std::find_if(leaves.begin(), leaves.end(),
                                    [&](const auto& leaf) { return leaf.first == expect.metric; });
    if (found == leaves.end()) {
      std::vector<std::string> paths;
      for (const auto& leaf : leaves) {
        paths.push_back(leaf.first);
      }
      const bool gone = metrics.manoeuvre && !metrics.manoeuvre->missing.empty();
      fail(fmt::format("no metric {}{}", UnknownName(expect.metric, paths),
                       gone ? " (" + metrics.manoeuvre->missing + ")" : ""));
      continue;
    }
    const nlohmann::ordered_json& value = found->second;
    if (expect.equals && !Equals(value, *expect.equals)) {
      fail(fmt::format("{} expected to be {}, was {}", expect.metric, *expect.equals,
                       value.is_string() ? value.get<std::string>() : value.dump()));
    }
    if (!expect.min && !expect.max) {
      continue;
    }
    if (!value.is_number()) {
      fail(fmt::format("{} expected to be a number, was {}", expect.metric, value.dump()));
      continue;
    }
    const double actual = value.get<double>();
    if (expect.min && !(actual >= *expect.min)) {
      fail(fmt::format("{} expected at least {:.4g}, was {:.4g}", expect.metric, *expect.min,
                       actual));
    }
    if (expect.max && !(actual <= *expect.max)) {
      fail(fmt::format("{} expected at most {:.4g}, was {:.4g}", expect.metric, *expect.max,
                       actual));
    }
  }
}

}  // namespace trackbed
