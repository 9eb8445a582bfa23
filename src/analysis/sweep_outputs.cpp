#include "trackbed/analysis/sweep_outputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/analysis/metric_table.h"
#include "trackbed/analysis/path_properties.h"
#include "trackbed/analysis/robustness.h"

namespace trackbed {
namespace {

/// Adds all defined properties of a planned path to a study row's outputs.
void AddPlanOutputs(const PlannedPath& path, Outputs& outputs) {
  for (const PathProperty& property : PathProperties()) {
    if (const std::optional<double> value = property.measure(path)) {
      outputs[fmt::format("plan.{}", property.name)] = ToText(*value);
    }
  }
}

}  // namespace

Outputs CollectOutputs(const RunResult& result) {
  Outputs outputs;
  for (const PlantMetrics& plant : result.metrics) {
    for (const Metric& metric : ListMetrics(plant)) {
      const std::string value = ToText(metric.value);
      outputs[fmt::format("metrics.{}.{}", plant.plant, metric.path)] = value;
      if (result.metrics.size() == 1) {
        outputs["metrics.*." + metric.path] = value;
      }
    }
  }
  for (const PlantComparison& comparison : result.comparisons) {
    for (const Metric& metric : ListMetrics(comparison)) {
      outputs[fmt::format("between.{}.{}.{}", comparison.first, comparison.second, metric.path)] =
          ToText(metric.value);
    }
  }
  const Verdict& verdict = result.verdict;
  outputs["verdict.passed"] = ToText(verdict.judged ? MetricValue(verdict.passed) : MetricValue());
  outputs["verdict.robustness"] =
      ToText(verdict.judged ? MetricValue(RobustnessOf(result).value) : MetricValue());
  outputs["verdict.failures"] = fmt::format("{}", fmt::join(verdict.failures, "; "));
  if (result.scenario.plan) {
    outputs["plan.status"] = ToString(result.plan->status);
    outputs["timing.planning_s"] = ToText(result.planning_time);
    if (result.plan.ok()) {
      AddPlanOutputs({result.plan, result.scenario.world, result.vehicle}, outputs);
    }
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
    all.metrics.push_back(AllMetrics(scenario, plant));
  }
  Outputs outputs = CollectOutputs(all);
  if (scenario.plan) {
    Plan plan;
    plan.waypoints = scenario.mission.waypoints;
    AddPlanOutputs({plan, scenario.world, all.vehicle}, outputs);
  }
  std::vector<std::string> paths;
  for (const auto& output : outputs) {
    paths.push_back(output.first);
  }
  return paths;
}

}  // namespace trackbed
