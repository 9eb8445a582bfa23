#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

const RunLog& FindLog(const RunResult& run, const std::string& plant) {
  if (const std::optional<PlantRun> found = run.Find(plant)) {
    return found->log;
  }
  std::vector<std::string> driven;
  for (const RunLog& log : run.logs) {
    driven.push_back(log.plant);
  }
  throw InputError(
      Problem{.message = fmt::format("the run {} has no plant {}; it has: {}", run.scenario.name,
                                     plant, fmt::join(driven, ", "))});
}

}  // namespace

std::optional<PlantRun> RunResult::Find(const std::string& plant) const {
  const auto log = std::find_if(logs.begin(), logs.end(),
                                [&](const RunLog& each) { return each.plant == plant; });
  const auto own = std::find_if(metrics.begin(), metrics.end(),
                                [&](const PlantMetrics& each) { return each.plant == plant; });
  if (log == logs.end() || own == metrics.end()) {
    return std::nullopt;
  }
  return PlantRun{*log, *own};
}

Scenario LoadScenario(const std::filesystem::path& file, const std::vector<Override>& overrides,
                      const std::vector<std::filesystem::path>& asset_folders) {
  return ReadScenario(file, overrides, PossibleMetrics, asset_folders);
}

RunResult RunScenario(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return RunScenario(LoadScenario(file, overrides));
}

PlantComparison Compare(const RunResult& run, const std::string& first, const std::string& second) {
  return ComparePlants(FindLog(run, first), FindLog(run, second));
}

PlantComparison Compare(const RunResult& first, const RunResult& second, const std::string& plant) {
  PlantComparison comparison = ComparePlants(FindLog(first, plant), FindLog(second, plant));
  comparison.first = first.scenario.name + "/" + plant;
  comparison.second = second.scenario.name + "/" + plant;
  return comparison;
}

}  // namespace trackbed
