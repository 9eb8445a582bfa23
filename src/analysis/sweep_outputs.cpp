#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "src/analysis/json_leaves.h"
#include "src/analysis/metric_expectations.h"
#include "trackbed/analysis/sweep.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

std::string TextOf(const ordered_json& value) {
  if (value.is_number_float()) {
    return ShortestText(value.get<double>());
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

Outputs OutputsOf(const RunResult& result) {
  ordered_json json;
  json["metrics"] = MetricsJson(result)["plants"];
  if (result.metrics.size() == 1) {
    const ordered_json only = json["metrics"].front();
    json["metrics"]["*"] = only;
  }
  for (const PlantComparison& comparison : result.comparisons) {
    ordered_json& between = json["between"][comparison.first][comparison.second];
    between = ToJson(comparison);
    between.erase("plants");
  }
  json["verdict"] = {{"passed", ToJson(result.verdict)["passed"]},
                     {"failures", fmt::format("{}", fmt::join(result.verdict.failures, "; "))}};
  if (result.scenario.plan) {
    json["plan"]["status"] = ToString(result.plan.status);
    if (result.plan.ok()) {
      json["plan"]["length_m"] = result.plan.reference.path.length();
    }
  }
  Outputs outputs;
  for (const auto& [path, value] : LeavesOf(json)) {
    outputs[path] = TextOf(value);
  }
  return outputs;
}

std::vector<std::string> PossibleOutputs(const Scenario& scenario) {
  RunResult all;
  all.scenario = scenario;
  for (const std::string& plant : scenario.drive.plants) {
    for (const PlantMetrics& other : all.metrics) {
      all.comparisons.push_back({.first = other.plant, .second = plant});
    }
    all.metrics.push_back(EveryMetricOf(scenario, plant));
  }
  std::vector<std::string> paths;
  for (const auto& output : OutputsOf(all)) {
    paths.push_back(output.first);
  }
  return paths;
}

}  // namespace trackbed
