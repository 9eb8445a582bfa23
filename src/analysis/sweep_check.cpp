#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "trackbed/analysis/sweep.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

using CarKey = std::tuple<std::string, double, double>;

/// What tells the bare cars of scenarios apart.
CarKey MakeCarKey(const Scenario& scenario) {
  return {FindModel(scenario.vehicle.model, scenario.folder).string(), scenario.drive.timestep,
          scenario.vehicle.steering_rate.value_or(0.0)};
}

/// The scenario with nothing put into the car's scene.
Scenario Bare(Scenario scenario) {
  scenario.world.obstacles.clear();
  scenario.world.ground = {};
  scenario.disturb.payload.reset();
  return scenario;
}

/// Does something for each point that is a scenario, and refuses those for which that throws an
/// InputError. `check` is called once for points of one key.
template <typename Key>
void CheckPoints(CheckedStudy& checked, BadPoints bad_points,
                 const std::function<Key(const Scenario& scenario)>& key_of,
                 const std::function<void(const Scenario& scenario)>& check) {
  std::vector<Problem> problems;
  std::map<Key, std::string> refusals;
  bool any_good = false;
  for (StudyPoint& point : checked.points) {
    if (!point.refused.empty()) {
      continue;
    }
    const auto [at, is_new] = refusals.try_emplace(key_of(point.scenario));
    if (is_new) {
      try {
        check(point.scenario);
      } catch (const InputError& error) {
        problems.insert(problems.end(), error.problems().begin(), error.problems().end());
        at->second = error.problems().front().WithoutPlace();
      }
    }
    point.refused = at->second;
    any_good = any_good || point.refused.empty();
  }
  if (!problems.empty() && (bad_points == BadPoints::kThrow || !any_good)) {
    throw InputError(problems);
  }
}

/// Puts every car once on each of its plants: not every car has what every plant asks of it.
void CheckPlants(const CheckedStudy& checked, const Scenario& scenario) {
  std::vector<Problem> problems;
  const World bare;
  const auto compiled = checked.cars->Load(Bare(scenario));
  for (const std::string& plant : scenario.drive.plants) {
    try {
      MakePlant(plant,
                {.car = *compiled, .world = bare, .start = {}, .tyre = scenario.vehicle.tyre});
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

void CheckOutputs(const CheckedStudy& checked) {
  std::set<std::string> possible;
  for (const StudyPoint& point : checked.points) {
    if (point.refused.empty()) {
      const std::vector<std::string> own = PossibleOutputs(point.scenario);
      possible.insert(own.begin(), own.end());
    }
  }
  std::vector<Problem> problems;
  const std::vector<OutputSpec>& outputs = checked.study.outputs;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const OutputSpec& output = outputs[i];
    if (possible.find(output.path) == possible.end()) {
      problems.push_back(
          {checked.study.file, output.line, output.column, fmt::format("outputs[{}]", i),
           "unknown metric " + UnknownName(output.path, {possible.begin(), possible.end()})});
    }
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

}  // namespace

CheckedStudy CheckStudy(Study study, BadPoints bad_points) {
  CheckedStudy checked{
      .study = std::move(study), .points = {}, .cars = std::make_unique<CarCache>()};
  checked.points = ReadPoints(checked.study, bad_points);
  CheckPoints<CarKey>(checked, bad_points, MakeCarKey,
                      [&](const Scenario& scenario) { checked.cars->Load(Bare(scenario)); });
  using PlantsKey = std::tuple<CarKey, std::vector<std::string>, TyreLaw>;
  CheckPoints<PlantsKey>(
      checked, bad_points,
      [](const Scenario& scenario) {
        return PlantsKey{MakeCarKey(scenario), scenario.drive.plants, scenario.vehicle.tyre};
      },
      [&](const Scenario& scenario) { CheckPlants(checked, scenario); });
  CheckOutputs(checked);
  return checked;
}

std::optional<RunOutcome> DriveOnce(const CheckedStudy& checked, const Scenario& scenario,
                                    const std::function<bool()>& interrupted) {
  const RunHooks hooks{.drive = [&](const std::string&) {
    return DriveHooks{.progress = {}, .interrupted = interrupted};
  }};
  const RunResult result = RunMission(scenario, *checked.cars, hooks);
  if (result.interrupted) {
    return std::nullopt;
  }
  const bool passed = result.verdict.passed;
  // Without a plan the verdict has one failure, which tells of it.
  return RunOutcome{.status = !result.plan.ok()        ? "no_plan"
                              : !result.verdict.judged ? "driven"
                              : passed                 ? "passed"
                                                       : "failed",
                    .passed = passed,
                    .reason = fmt::format("{}", fmt::join(result.verdict.failures, "; ")),
                    .outputs = CollectOutputs(result)};
}

}  // namespace trackbed
