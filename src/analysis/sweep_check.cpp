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

void CompileCars(CheckedStudy& checked) {
  std::vector<Problem> problems;
  std::set<CarKey> tried;
  for (const StudyPoint& point : checked.points) {
    if (!tried.insert(MakeCarKey(point.scenario)).second) {
      continue;
    }
    try {
      checked.cars->Load(Bare(point.scenario));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

/// Puts every car once on each of its plants: not every car has what every plant asks of it.
void CheckPlants(const CheckedStudy& checked) {
  std::vector<Problem> problems;
  std::set<std::tuple<CarKey, std::string, TyreLaw>> tried;
  const World bare;
  for (const StudyPoint& point : checked.points) {
    const auto car = MakeCarKey(point.scenario);
    const TyreLaw tyre = point.scenario.vehicle.tyre;
    for (const std::string& plant : point.scenario.drive.plants) {
      if (!tried.insert({car, plant, tyre}).second) {
        continue;
      }
      try {
        const auto compiled = checked.cars->Load(Bare(point.scenario));
        MakePlant(plant, {.car = *compiled, .world = bare, .start = {}, .tyre = tyre});
      } catch (const InputError& error) {
        problems.insert(problems.end(), error.problems().begin(), error.problems().end());
      }
    }
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

void CheckOutputs(const CheckedStudy& checked) {
  std::set<std::string> possible;
  for (const StudyPoint& point : checked.points) {
    const std::vector<std::string> own = PossibleOutputs(point.scenario);
    possible.insert(own.begin(), own.end());
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

CheckedStudy CheckStudy(Study study) {
  CheckedStudy checked{
      .study = std::move(study), .points = {}, .cars = std::make_unique<CarCache>()};
  checked.points = ReadPoints(checked.study);
  CompileCars(checked);
  CheckPlants(checked);
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
  return RunOutcome{.status = !result.plan.ok()        ? "no_plan"
                              : !result.verdict.judged ? "driven"
                              : passed                 ? "passed"
                                                       : "failed",
                    .passed = passed,
                    .outputs = CollectOutputs(result)};
}

}  // namespace trackbed
