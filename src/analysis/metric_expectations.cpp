#include "src/analysis/metric_expectations.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/analysis/json_leaves.h"
#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

using Leaves = std::vector<std::pair<std::string, nlohmann::ordered_json>>;

const nlohmann::ordered_json* Find(const Leaves& leaves, const std::string& path) {
  const auto found = std::find_if(leaves.begin(), leaves.end(),
                                  [&](const auto& leaf) { return leaf.first == path; });
  return found == leaves.end() ? nullptr : &found->second;
}

/// Where and when a metric was what it is: a largest value stands beside its `…_s` and `…_t`.
std::string Whereabouts(const std::string& path, const Leaves& leaves,
                        const PlantMetrics& metrics) {
  const nlohmann::ordered_json* s = Find(leaves, path + "_s");
  const nlohmann::ordered_json* t = Find(leaves, path + "_t");
  if (s != nullptr && t != nullptr) {
    return fmt::format(" at s = {:.4g} m, t = {:.4g} s", s->get<double>(), t->get<double>());
  }
  if (path.starts_with("manoeuvre.") && metrics.manoeuvre) {
    return fmt::format(" between t = {:.4g} s and {:.4g} s", metrics.manoeuvre->begin,
                       metrics.manoeuvre->end);
  }
  if (path == "status" || path == "distance" || path == "time" || path == "cross_track.final" ||
      path.starts_with("goal_")) {
    return fmt::format(" at the end, s = {:.4g} m, t = {:.4g} s", metrics.end_s, metrics.time);
  }
  return "";
}

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
  const Leaves leaves = LeavesOf(ToJson(metrics));
  const auto fail = [&](std::string message) {
    verdict.failures.push_back(metrics.plant + ": " + std::move(message));
  };
  for (const MetricExpectation& expect : expectations) {
    const nlohmann::ordered_json* found = Find(leaves, expect.metric);
    if (found == nullptr) {
      std::vector<std::string> paths;
      for (const auto& leaf : leaves) {
        paths.push_back(leaf.first);
      }
      const bool gone = metrics.manoeuvre && !metrics.manoeuvre->missing.empty();
      fail(fmt::format("no metric {}{}", UnknownName(expect.metric, paths),
                       gone ? " (" + metrics.manoeuvre->missing + ")" : ""));
      continue;
    }
    const nlohmann::ordered_json& value = *found;
    const std::string where = Whereabouts(expect.metric, leaves, metrics);
    if (expect.equals && !Equals(value, *expect.equals)) {
      fail(fmt::format("{} expected to be {}, was {}{}", expect.metric, *expect.equals,
                       value.is_string() ? value.get<std::string>() : value.dump(), where));
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
      fail(fmt::format("{} expected at least {:.4g}, was {:.4g}{}", expect.metric, *expect.min,
                       actual, where));
    }
    if (expect.max && !(actual <= *expect.max)) {
      fail(fmt::format("{} expected at most {:.4g}, was {:.4g}{}", expect.metric, *expect.max,
                       actual, where));
    }
  }
}

}  // namespace trackbed
