#include "trackbed/scenario/scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "src/scenario/check_requirements.h"
#include "src/scenario/check_values.h"
#include "src/scenario/commonroad_yaml.h"
#include "src/scenario/cross_check.h"
#include "src/scenario/input_files.h"
#include "src/scenario/inputs.h"
#include "src/scenario/local_origin.h"
#include "src/scenario/overrides.h"
#include "src/scenario/read_section.h"
#include "src/scenario/route_world.h"
#include "src/scenario/scenario_yaml.h"
#include "src/scenario/start_state.h"
#include "src/scenario/visit.h"
#include "src/scenario/yaml_file.h"
#include "src/scenario/yaml_reader.h"
#include "src/scenario/yaml_writer.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/file.h"
#include "trackbed/path_files/commonroad_scenario.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/car_lengths.h"
#include "trackbed/scenario/input_files.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/scenario/metric_names.h"
#include "trackbed/sim/scene.h"

// Reads a scenario. ReadScenario parses the YAML, applies the overrides, visits all keys (visit.h)
// and reads the files that the keys name (inputs.cpp). Finally, ReadScenario checks rules between
// keys (cross_check.cpp), requirements and names of metrics. All problems of a scenario are
// collected and reported in the order of the file. A CommonRoad file is converted to the YAML of a
// scenario before it is parsed. ResolvedYaml writes a scenario as YAML (the resolved scenario). The
// resolved scenario contains all default values explicitly; its file names are the names of the
// copies in a run folder.
namespace trackbed {
namespace {

/// Removes expectations on plants that the scenario does not run. DropUnusedExpectations is called
/// only if the command line overrides drive.plants, because a user who overrides the plants should
/// not have to edit the expectations. In a scenario file, an expectation on a plant that is not run
/// is an error.
void DropUnusedExpectations(Scenario& scenario) {
  std::erase_if(scenario.expect.plants,
                [&](const auto& entry) { return !Drives(scenario, entry.first); });
  std::erase_if(scenario.expect.between, [&](const BetweenExpectation& between) {
    return std::any_of(between.plants.begin(), between.plants.end(),
                       [&](const std::string& plant) { return !Drives(scenario, plant); });
  });
}

/// Returns an error message if the list in the key `origin` is not a local origin, else "". If the
/// YAML node is not a list, the YAML reader itself reports this error.
std::string OriginError(const YAML::Node& node) {
  if (!node || !node.IsSequence()) {
    return "";
  }
  std::vector<double> numbers;
  for (const YAML::Node& number : node) {
    numbers.push_back(number.as<double>(0.5));
  }
  return OriginProblem(numbers);
}

/// Throws InputError if the given scenario file is a study. Without this check, the scenario reader
/// would report each key of a study as unknown.
void RefuseStudy(const YAML::Node& root, const std::string& file) {
  const YAML::Node named = root["scenario"];
  if (named && !root["mission"] && !root["drive"]) {
    const YAML::Mark mark = named.Mark();
    throw InputError(Problem{.file = file,
                             .line = mark.line + 1,
                             .column = mark.column + 1,
                             .key = "scenario",
                             .message = "the file is a study, which has many runs of this "
                                        "scenario; run it by `sweep`, or give the scenario"});
  }
}

/// Applies the overrides to the YAML tree, and appends their keys to `keys`. Returns the problems
/// of the overrides that could not be applied.
std::vector<Problem> ApplyOverrides(YAML::Node& root, const std::vector<Override>& overrides,
                                    std::vector<std::string>& keys) {
  std::vector<Problem> problems;
  for (const Override& override_text : overrides) {
    try {
      keys.push_back(ApplyOverride(root, override_text));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  return problems;
}

}  // namespace

Scenario ParseScenario(const std::string& yaml, const std::string& name,
                       const std::filesystem::path& folder, const std::vector<Override>& overrides,
                       const MetricPaths& metrics,
                       const std::vector<std::filesystem::path>& asset_folders) {
  YAML::Node root = LoadYaml(yaml, name);
  RefuseStudy(root, name);
  ReaderContext context{.file = name, .overridden = {}, .problems = {}};
  std::vector<Problem> problems = ApplyOverrides(root, overrides, context.overridden);
  Scenario scenario;
  scenario.folder = folder;
  scenario.asset_folders = asset_folders;
  // The factor on default lengths of the plan may depend on the vehicle, because Visit reads the
  // section `vehicle` before `plan`.
  context.car_length_scale = [&] { return CarLengthScale(scenario); };
  YamlReader reader(context, root, "");
  Visit(reader, scenario);
  reader.Finish();
  if (!problems.empty()) {
    // An override often fails because an earlier key is misspelled, so report both.
    problems.insert(problems.end(), context.problems.begin(), context.problems.end());
    throw InputError(problems);
  }
  const auto add_error = [&](const std::string& key, std::string message) {
    context.AddError(NodeAt(root, key).Mark(), key, std::move(message));
  };
  try {
    static_cast<void>(FindModel(scenario.vehicle.model, folder));
  } catch (const InputError& error) {
    add_error("vehicle.model", error.problems().front().message);
  }
  const std::vector<Problem> of_inputs = ReadInputs(scenario, context, add_error);
  if (std::string problem = CameraProblem(scenario.render.camera); !problem.empty()) {
    add_error("render.camera", std::move(problem));
  }
  if (std::find(context.overridden.begin(), context.overridden.end(), "drive.plants") !=
      context.overridden.end()) {
    DropUnusedExpectations(scenario);
  }
  if (context.Read("origin")) {
    if (const std::string wrong = OriginError(NodeAt(root, "origin")); !wrong.empty()) {
      add_error("origin", wrong);
    }
  }
  if (context.problems.empty() && of_inputs.empty()) {
    if (const auto mixed = MoveToLocalOrigin(scenario)) {
      add_error(mixed->first, mixed->second);
      throw InputError(context.problems);
    }
  }
  const auto could_read = [&context](const std::string& key) { return context.Read(key); };
  for (auto& [key, message] : CrossProblems(scenario, could_read)) {
    add_error(key, std::move(message));
  }
  if (context.problems.empty() && of_inputs.empty()) {
    for (auto& [key, message] : RequirementProblems(scenario)) {
      add_error(key, std::move(message));
    }
  }
  if (metrics && context.problems.empty() && of_inputs.empty()) {
    for (auto& [key, message] : UnknownMetrics(scenario.expect, metrics(scenario))) {
      add_error(key, std::move(message));
    }
  }
  context.SortProblems();
  context.problems.insert(context.problems.end(), of_inputs.begin(), of_inputs.end());
  if (!context.problems.empty()) {
    throw InputError(context.problems);
  }
  return scenario;
}

Scenario ReadScenario(const std::filesystem::path& file, const std::vector<Override>& overrides,
                      const MetricPaths& metrics,
                      const std::vector<std::filesystem::path>& asset_folders) {
  std::string text = ReadInput(file);
  if (IsCommonRoadScenario(text)) {
    text = CommonRoadYaml(file, text);
  }
  return ParseScenario(text, file.string(), file.parent_path(), overrides, metrics, asset_folders);
}

RenderSpec ReadRenderSpec(const std::filesystem::path& file) {
  return ReadSection<RenderSpec>(file, kRenderSection);
}

VehicleSpec ReadVehicleSpec(const std::filesystem::path& file) {
  return ReadSection<VehicleSpec>(file, kVehicleSection);
}

World ReadWorld(const std::filesystem::path& file) {
  World world = ReadSection<World>(file, kWorldSection);
  if (world.map) {
    const std::filesystem::path folder = file.parent_path();
    const AccessCheck access_error = [&](const std::filesystem::path& image) {
      return ImageAccessError(image, folder, {});
    };
    if (const std::string why = ReadAccessError(world.map->file, folder, {}); !why.empty()) {
      throw InputError(Problem{.file = file.string(),
                               .key = "world.map.file",
                               .message = fmt::format("{} {}", world.map->file, why)});
    }
    world.map->data =
        std::make_shared<const MapObstacles>(ReadMap(*world.map, folder, access_error));
  }
  const Vec2 origin = ReadOrigin(file);
  MoveToOrigin(world, origin);
  ReadRouteGround(file, origin, world);
  return world;
}

Expectations ReadExpectations(const std::filesystem::path& file) {
  return ReadSection<Expectations>(file, kExpectSection);
}

void CheckScenario(const Scenario& scenario) {
  // Run each check only if the earlier checks found no problem: rules between keys need valid
  // values, and formulas need the columns of a log.
  auto found = ValueProblems(scenario);
  if (found.empty()) {
    found = CrossProblems(scenario, [](const auto&) { return true; });
  }
  if (found.empty()) {
    found = RequirementProblems(scenario);
  }
  if (!found.empty()) {
    std::vector<Problem> problems;
    for (const auto& [key, message] : found) {
      problems.push_back({"", 0, 0, key, message});
    }
    throw InputError(problems);
  }
}

const Recording* FindRecording(const Scenario& scenario) {
  const ControllerOptions& steering = scenario.control.steering;
  const ControllerEntry& controller = ControllerFor(steering);
  return controller.recording != nullptr ? &controller.recording(steering) : nullptr;
}

std::optional<double> RunDuration(const Scenario& scenario) {
  if (scenario.mission.duration || scenario.plan) {
    return scenario.mission.duration;
  }
  if (scenario.record && scenario.record->data) {
    return scenario.record->data->duration();
  }
  const ControllerOptions& steering = scenario.control.steering;
  const ControllerEntry& controller = ControllerFor(steering);
  return controller.duration != nullptr ? controller.duration(steering) : std::nullopt;
}

Vec2 OriginOf(const Scenario& scenario) {
  return scenario.origin.value_or(Vec2::Zero());
}

StartState InitialState(const Scenario& scenario) {
  return StartOfMission(scenario);
}

PlannerOptions DefaultPlanner() {
  return Planners().front().defaults;
}

ControllerOptions DefaultController() {
  return PreviewOptions{};
}

double MissionSpeed(const Scenario& scenario) {
  const double speed = scenario.mission.speed;
  return speed > 0.0 ? speed : InitialState(scenario).speed;
}

namespace {

template <typename Options>
std::string OneLine(Options options) {
  YAML::Emitter out;
  out << YAML::Flow << YAML::BeginMap;
  YamlWriter writer(out);
  Visit(writer, options);
  out << YAML::EndMap;
  // Remove the braces in which the YAML emitter encloses the text of a section.
  const std::string text = out.c_str();
  return text.substr(1, text.size() - 2);
}

}  // namespace

std::string OptionDefaults(const PlannerOptions& options) {
  return OneLine(options);
}

std::string OptionDefaults(const AvoiderOptions& options) {
  return OneLine(options);
}

std::string OptionDefaults(const ControllerOptions& options) {
  return OneLine(options);
}

std::string OptionDefaults(const ManeuverOptions& options) {
  return OneLine(options);
}

std::string ResolvedYaml(const Scenario& scenario) {
  Scenario resolved = WithResolvedFiles(scenario);
  const StartState start = InitialState(scenario);
  const bool route_sets_steering =
      scenario.plan && PlannerFor(scenario.plan->global).start_curvature != nullptr;
  // If a recorded drive or the route determines the initial steering angle, write this angle only
  // if the user has specified it. When the resolved scenario is run, SimulateScenario and
  // InitialState compute the initial steering angle again.
  const std::optional<double> steering =
      scenario.record || route_sets_steering ? scenario.mission.start.steering : start.steering;
  resolved.mission.start = {start.pose.x, start.pose.y, start.pose.yaw, start.speed, steering};
  resolved.mission.duration = RunDuration(scenario);
  return YamlOf(resolved);
}

}  // namespace trackbed
