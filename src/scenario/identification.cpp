#include "trackbed/scenario/identification.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "src/scenario/identification_visit.h"
#include "src/scenario/inputs.h"
#include "src/scenario/yaml_file.h"
#include "src/scenario/yaml_reader.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"
#include "trackbed/recording/banked_track.h"
#include "trackbed/scenario/input_files.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/scene.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

void CheckParameters(Identification& study, const YAML::Node& root, ReaderContext& context) {
  const auto add_error = [&](const std::string& key, std::string message) {
    context.AddError(NodeAt(root, key).Mark(), key, std::move(message));
  };
  if (study.parameters.empty()) {
    add_error("parameters", "needs at least one parameter");
  }
  // Largest number of parameters to identify, because QuadraticProgram supports no more variables.
  constexpr std::size_t kMaxParameters = 40;
  if (study.parameters.size() > kMaxParameters) {
    add_error("parameters",
              fmt::format("at most {}; found {}", kMaxParameters, study.parameters.size()));
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < study.parameters.size(); ++i) {
    IdentifiedParameter& parameter = study.parameters[i];
    const std::string key = fmt::format("parameters[{}]", i);
    const YAML::Mark mark = NodeAt(root, key + ".name").Mark();
    parameter.line = mark.line + 1;
    parameter.column = mark.column + 1;
    if (!names.insert(parameter.name).second) {
      add_error(key + ".name", fmt::format("'{}' is estimated already", parameter.name));
    }
    if (!(parameter.from < parameter.to)) {
      add_error(key + ".to",
                fmt::format("must be above from, {}; found {}", parameter.from, parameter.to));
    } else if (parameter.start &&
               (*parameter.start < parameter.from || *parameter.start > parameter.to)) {
      add_error(key + ".start", fmt::format("must be between {} and {}; found {}", parameter.from,
                                            parameter.to, *parameter.start));
    }
  }
  if (study.fit.empty()) {
    add_error("fit", "needs at least one scenario with a record");
  }
}

/// Reads the scenario files that the identification file lists. Adds a problem for each listed
/// scenario that has no recorded drive, or another vehicle than the first scenario.
std::vector<Scenario> ReadRecords(const std::vector<std::string>& files, const std::string& list,
                                  const fs::path& folder, const std::vector<fs::path>& assets,
                                  const Scenario* first, const YAML::Node& root,
                                  ReaderContext& context) {
  std::vector<Scenario> scenarios;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string key = fmt::format("{}[{}]", list, i);
    const auto add_error = [&](std::string message) {
      context.AddError(NodeAt(root, key).Mark(), key, std::move(message));
    };
    Scenario scenario = ReadScenario(folder / files[i], {}, {}, assets);
    if (!scenario.record) {
      add_error(fmt::format("{} has no record to compare with", files[i]));
      continue;
    }
    const VehicleSpec& own = scenario.vehicle;
    const Scenario& reference = first != nullptr    ? *first
                                : scenarios.empty() ? scenario
                                                    : scenarios.front();
    const VehicleSpec& vehicle = reference.vehicle;
    const fs::path model = FindModel(own.model, scenario.folder);
    const fs::path its_model = FindModel(vehicle.model, reference.folder);
    std::error_code ignored;
    if (!fs::equivalent(model, its_model, ignored) ||
        scenario.drive.timestep != reference.drive.timestep ||
        own.steering_rate != vehicle.steering_rate ||
        MakeSceneOptions(scenario).tyre_numbers != MakeSceneOptions(reference).tyre_numbers) {
      add_error(
          fmt::format("{} has another vehicle, tyre file, steering rate or timestep than the first "
                      "scenario; one model is fitted to all",
                      files[i]));
    }
    scenarios.push_back(std::move(scenario));
  }
  return scenarios;
}

/// Checks that the names of the scenarios in an identification differ, because output files are
/// named after the scenarios.
void CheckRecordNames(const Identification& study, const YAML::Node& root, ReaderContext& context) {
  std::set<std::string> names;
  for (const auto& [list, scenarios] :
       {std::pair("fit", &study.fit_scenarios), std::pair("held_out", &study.held_out_scenarios)}) {
    for (std::size_t i = 0; i < scenarios->size(); ++i) {
      const std::string& name = (*scenarios)[i].name;
      if (!names.insert(name).second) {
        const std::string key = fmt::format("{}[{}]", list, i);
        context.AddError(NodeAt(root, key).Mark(), key,
                         fmt::format("its scenario has the name '{}', as one before; give each "
                                     "another name",
                                     name));
      }
    }
  }
}

/// Reads the banked track, whose surface becomes the ground of the identification runs. Checks that
/// the plant simulates the banked ground, and that no scenario of the identification defines
/// another ground.
void ReadBank(Identification& study, const std::vector<fs::path>& assets, const YAML::Node& root,
              ReaderContext& context) {
  const auto add_error = [&](const std::string& key, std::string message) {
    context.AddError(NodeAt(root, key).Mark(), key, std::move(message));
  };
  if (!study.plant.starts_with("mujoco")) {
    add_error("bank", fmt::format("the plant {} ignores the ground; set plant: mujoco, or remove "
                                  "bank",
                                  study.plant));
  }
  for (const auto* scenarios : {&study.fit_scenarios, &study.held_out_scenarios}) {
    for (const Scenario& scenario : *scenarios) {
      if (!IsFlat(scenario.world.ground)) {
        add_error("bank", fmt::format("{} has a ground already; remove its ground, or bank",
                                      scenario.name));
      }
    }
  }
  if (!study.bank->track) {
    return;
  }
  const fs::path folder = study.file.parent_path();
  if (const std::string why = ReadAccessError(*study.bank->track, folder, WithOwnData(assets));
      !why.empty()) {
    add_error("bank.track", fmt::format("{} {}", *study.bank->track, why));
    return;
  }
  try {
    study.bank->center = ReadCenterPoints(folder / *study.bank->track);
  } catch (const RunError& error) {
    add_error("bank.track", error.what());
  }
}

}  // namespace

Identification ReadIdentification(const fs::path& file,
                                  const std::vector<fs::path>& asset_folders) {
  const YAML::Node root = LoadYaml(ReadInput(file), file.string(), "an identification");
  ReaderContext context{.file = file.string(), .overridden = {}, .problems = {}};
  Identification study;
  study.file = file;
  YamlReader reader(context, root, "");
  Visit(reader, study);
  reader.Finish();
  context.ThrowProblems();
  CheckParameters(study, root, context);
  context.ThrowProblems();
  const fs::path folder = file.parent_path();
  study.fit_scenarios =
      ReadRecords(study.fit, "fit", folder, asset_folders, nullptr, root, context);
  const Scenario* first = study.fit_scenarios.empty() ? nullptr : &study.fit_scenarios.front();
  study.held_out_scenarios =
      ReadRecords(study.held_out, "held_out", folder, asset_folders, first, root, context);
  context.ThrowProblems();
  CheckRecordNames(study, root, context);
  if (study.bank) {
    ReadBank(study, asset_folders, root, context);
  }
  context.ThrowProblems();
  return study;
}

bool IsIdentification(const fs::path& file) {
  try {
    const YAML::Node root = LoadYaml(ReadInput(file), file.string(), "an identification");
    return root["parameters"] && root["fit"];
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace trackbed
