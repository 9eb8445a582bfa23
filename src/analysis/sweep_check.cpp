#include "trackbed/analysis/sweep_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "trackbed/core/error.h"
#include "trackbed/core/hash.h"
#include "trackbed/core/spelling.h"
#include "trackbed/scenario/input_files.h"
#include "trackbed/scenario/study_check.h"
#include "trackbed/sim/scene.h"

namespace trackbed {
namespace {

using CarKey = std::tuple<std::string, double, double>;

/// Returns a text with the specified numbers of a trailer, as a part of a key.
std::string KeyOf(const std::optional<TrailerOptions>& trailer) {
  std::string key;
  if (trailer) {
    for (const std::optional<double>& number :
         {trailer->hitch, trailer->hitch_height, trailer->tongue, trailer->track, trailer->length,
          trailer->width, trailer->height, trailer->body_ahead, trailer->mass, trailer->yaw_inertia,
          trailer->cg_ahead, trailer->cg_height, trailer->wheel_radius}) {
      key += number ? fmt::format("{} ", *number) : "- ";
    }
  }
  return key;
}

/// Returns a key that is equal for scenarios whose compiled car models, without obstacles, are
/// equal.
CarKey MakeCarKey(const Scenario& scenario) {
  const VehicleSpec& vehicle = scenario.vehicle;
  return {fmt::format("{}\n{}\n{}\n{}", FindModel(vehicle.model, scenario.folder).string(),
                      vehicle.tyre_file.value_or(""), vehicle.tyre_file_rear.value_or(""),
                      KeyOf(vehicle.trailer)),
          scenario.drive.timestep, vehicle.steering_rate.value_or(0.0)};
}

/// Returns a copy of the scenario without obstacles, map, ground and payload.
Scenario Bare(Scenario scenario) {
  scenario.world.obstacles.clear();
  scenario.world.map.reset();
  scenario.world.ground = {};
  scenario.disturb.payload.reset();
  return scenario;
}

/// Checks only the first of all scenarios with the same key, and collects the problems that the
/// checks report.
template <typename Key>
class OncePerKey {
 public:
  explicit OncePerKey(std::function<void(const Scenario& scenario)> check)
      : check_(std::move(check)) {}

  /// Returns whether the check succeeds for scenarios with the given key.
  bool operator()(const Key& key, const Scenario& scenario) {
    const auto [at, is_new] = good_.try_emplace(key, true);
    if (is_new) {
      try {
        check_(scenario);
      } catch (const InputError& error) {
        problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
        at->second = false;
      }
    }
    return at->second;
  }

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::function<void(const Scenario& scenario)> check_;
  std::map<Key, bool> good_;
  std::vector<Problem> problems_;
};

/// Checks that each plant can be constructed with the scenario's car, because some plants need
/// model elements that the car's MuJoCo model may lack.
void CheckPlants(const CheckedStudy& checked, const Scenario& scenario) {
  std::vector<Problem> problems;
  const World bare;
  const auto compiled = checked.cars->Load(Bare(scenario));
  for (const std::string& plant : scenario.drive.plants) {
    if (plant == kRecordedPlant) {
      continue;
    }
    try {
      MakePlant(plant, {.car = *compiled,
                        .world = bare,
                        .start = {},
                        .tyre = scenario.vehicle.tyre,
                        .aids = scenario.vehicle.aids.value_or(AidOptions{})});
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

void CheckOutputs(const Study& study, const std::set<std::string>& possible) {
  std::vector<Problem> problems;
  const std::vector<OutputSpec>& outputs = study.outputs;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const OutputSpec& output = outputs[i];
    if (possible.find(output.path) == possible.end()) {
      problems.push_back(
          {study.file, output.line, output.column, fmt::format("outputs[{}]", i),
           "unknown metric " + UnknownName(output.path, {possible.begin(), possible.end()})});
    }
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

/// Returns the SHA-256 of a car's model and of the model's asset files.
std::string HashOfModel(const Scenario& scenario) {
  const Scene scene = ComposeScene(FindModel(scenario.vehicle.model, scenario.folder),
                                   {.tyre_numbers = MakeSceneOptions(scenario).tyre_numbers});
  Sha256Sum hash;
  hash.Add(scene.xml);
  for (const auto& asset : scene.assets) {
    hash.Add(asset.name);
    hash.Add(asset.content);
  }
  return hash.Finish();
}

/// Adds the SHA-256 of each input file of the scenario to `hashes`, keyed by the kind and the name
/// of the file, such as "path lane.csv". The two files of a map share one key and one hash in the
/// list of input files.
void AddInputHashes(const Scenario& scenario, std::map<std::string, std::string>& hashes) {
  std::map<std::string, std::string> contents;
  for (const InputFile& file : InputFiles(scenario)) {
    contents[file.source] += file.content;
  }
  for (const auto& [source, content] : contents) {
    hashes[source] = Sha256(content);
  }
}

}  // namespace

CheckedStudy CheckStudy(Study study, bool all) {
  CheckedStudy checked{
      .points = StudyPoints(std::move(study)), .cars = std::make_unique<CarCache>(), .inputs = {}};
  CheckPoints(checked.points, all);
  checked.inputs["scenario"] = Sha256(checked.points.study().scenario_text);
  // The last three elements of PlantsKey are the driver aids.
  using PlantsKey = std::tuple<CarKey, std::vector<std::string>, TyreLaw, bool, bool, Differential>;
  OncePerKey<CarKey> compiles([&](const Scenario& scenario) {
    checked.cars->Load(Bare(scenario));
    checked.inputs["model " + scenario.vehicle.model] = HashOfModel(scenario);
  });
  OncePerKey<PlantsKey> drives([&](const Scenario& scenario) { CheckPlants(checked, scenario); });
  std::set<std::string> possible;
  bool any_valid = false;
  for (const std::size_t i : PointsToCheck(checked.points)) {
    const StudyPoint point = checked.points.Read(i);
    const Scenario& scenario = point.scenario;
    if (!point.refused.empty()) {
      continue;
    }
    const CarKey car = MakeCarKey(scenario);
    const AidOptions aids = scenario.vehicle.aids.value_or(AidOptions{});
    if (compiles(car, scenario) && drives({car, scenario.drive.plants, scenario.vehicle.tyre,
                                           aids.abs, aids.esc, aids.differential},
                                          scenario)) {
      any_valid = true;
      const std::vector<std::string> own = PossibleOutputs(scenario);
      possible.insert(own.begin(), own.end());
    }
    AddInputHashes(scenario, checked.inputs);
  }
  std::vector<Problem> problems = compiles.problems();
  problems.insert(problems.end(), drives.problems().begin(), drives.problems().end());
  if (!problems.empty() && (all || !any_valid)) {
    throw InputError(problems);
  }
  CheckOutputs(checked.points.study(), possible);
  return checked;
}

std::optional<RunOutcome> DriveOnce(const CheckedStudy& checked, const Scenario& scenario,
                                    const std::function<bool()>& interrupted) {
  const RunHooks hooks{.drive = [&](const std::string&) {
    return DriveHooks{.progress = {}, .interrupted = interrupted};
  }};
  RunResult result = RunScenario(scenario, *checked.cars, hooks);
  if (result.interrupted) {
    return std::nullopt;
  }
  const bool passed = result.verdict.passed;
  // If planning failed, the verdict contains a single failure message with the reason.
  RunOutcome outcome{.status = !result.plan.ok()        ? "no_plan"
                               : !result.verdict.judged ? "driven"
                               : passed                 ? "passed"
                                                        : "failed",
                     .passed = passed,
                     .reason = fmt::format("{}", fmt::join(result.verdict.failures, "; ")),
                     .outputs = CollectOutputs(result)};
  outcome.result = std::move(result);
  return outcome;
}

}  // namespace trackbed
