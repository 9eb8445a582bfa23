#include "trackbed/scenario/scenario.h"

#include <algorithm>
#include <cmath>

#include "src/scenario/overrides.h"
#include "src/scenario/visit.h"
#include "src/scenario/yaml_file.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

bool Drives(const Scenario& scenario, const std::string& plant) {
  const auto& plants = scenario.drive.plants;
  return std::find(plants.begin(), plants.end(), plant) != plants.end();
}

/// A file must not expect anything of a plant it does not drive; but who asks for other plants than
/// the file's does not want to rewrite its expectations.
void DropWhatIsNotDriven(Scenario& scenario) {
  std::erase_if(scenario.expect.plants,
                [&](const auto& entry) { return !Drives(scenario, entry.first); });
  std::erase_if(scenario.expect.between, [&](const BetweenExpectation& between) {
    return std::any_of(between.plants.begin(), between.plants.end(),
                       [&](const std::string& plant) { return !Drives(scenario, plant); });
  });
}

/// Problems that concern more than one key, each with the key to change.
std::vector<std::pair<std::string, std::string>> CrossProblems(const Scenario& scenario) {
  std::vector<std::pair<std::string, std::string>> found;
  const MissionSpec& mission = scenario.mission;
  const DriveSpec& drive = scenario.drive;
  if (scenario.plan && mission.waypoints.empty()) {
    found.emplace_back("mission.waypoints", "missing; a plan needs waypoints");
  }
  const ControllerEntry& controller = ControllerFor(scenario.control.steering);
  if (controller.needs_plan && !scenario.plan) {
    found.emplace_back("plan",
                       fmt::format("missing; the controller {} follows a plan", controller.name));
  }
  if (scenario.plan && mission.duration) {
    found.emplace_back("mission.duration", "with a plan the drive ends at the goal; leave one out");
  }
  const RenderSpec& render = scenario.render;
  if (render.width % 2 != 0 || render.height % 2 != 0 || render.height > 4320) {
    found.emplace_back("render.size",
                       fmt::format("{}x{}: both must be even, the height at most 4320",
                                   render.width, render.height));
  }
  if (!scenario.plan && !mission.duration) {
    found.emplace_back("mission.duration", "missing; without a plan there is no goal to stop at");
  }
  const double steps = drive.control_period / drive.timestep;
  if (std::abs(steps - std::round(steps)) > 1e-6 || steps < 0.5) {
    found.emplace_back("drive.control_period",
                       fmt::format("{} s is not a whole number of timesteps of {} s",
                                   drive.control_period, drive.timestep));
  }
  if (drive.plants.empty()) {
    found.emplace_back("drive.plants", "at least one plant is needed");
  }
  if (const auto* fillet = scenario.plan ? std::get_if<FilletOptions>(&*scenario.plan) : nullptr) {
    if (!fillet->radius && fillet->constraint == RadiusConstraint::kNone) {
      found.emplace_back("plan.constraint", "'none' needs a radius: nothing else would limit it");
    }
  }
  for (const auto& [plant, expectation] : scenario.expect.plants) {
    if (!Drives(scenario, plant)) {
      found.emplace_back("expect." + plant, "drive.plants does not drive this plant");
    }
  }
  for (std::size_t i = 0; i < scenario.expect.between.size(); ++i) {
    const std::string key = fmt::format("expect.between[{}].plants", i);
    const auto& plants = scenario.expect.between[i].plants;
    if (plants.size() != 2) {
      found.emplace_back(key, fmt::format("expected two plants, found {}", plants.size()));
    } else if (!Drives(scenario, plants[0]) || !Drives(scenario, plants[1])) {
      found.emplace_back(key, "drive.plants does not drive both of them");
    }
  }
  if (!scenario.plan) {
    const auto needs_path = [&](const std::string& key, const PlantExpectation& expectation) {
      if (expectation.reach_goal || expectation.max_cross_track || expectation.rms_cross_track ||
          expectation.max_heading_error) {
        found.emplace_back(key, "without a plan there is no goal and no path to be off");
      }
    };
    needs_path("expect", scenario.expect.all);
    for (const auto& [plant, expectation] : scenario.expect.plants) {
      needs_path("expect." + plant, expectation);
    }
  }
  if (scenario.world.obstacles.empty()) {
    const auto needs_obstacles = [&](const std::string& key, const PlantExpectation& expectation) {
      if (expectation.min_clearance || expectation.collision.value_or(false)) {
        found.emplace_back(key,
                           "without world.obstacles there is nothing to be clear of or to hit");
      }
    };
    needs_obstacles("expect", scenario.expect.all);
    for (const auto& [plant, expectation] : scenario.expect.plants) {
      needs_obstacles("expect." + plant, expectation);
    }
  }
  return found;
}

/// The node that a dotted key names, or the nearest one above it that is there.
YAML::Node NodeAt(const YAML::Node& root, const std::string& key) {
  YAML::Node node(root);
  std::size_t begin = 0;
  while (begin <= key.size()) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    const std::string name = key.substr(begin, end - begin);
    if (!node.IsMap() || !node[name.substr(0, name.find('['))]) {
      break;
    }
    node.reset(node[name.substr(0, name.find('['))]);
    begin = end + 1;
  }
  return node;
}

}  // namespace

Scenario ParseScenario(const std::string& yaml, const std::string& name,
                       const std::filesystem::path& folder,
                       const std::vector<Override>& overrides) {
  YAML::Node root = LoadYaml(yaml, name);
  ReaderContext context{.file = name, .overridden = {}, .problems = {}};
  for (const Override& override_text : overrides) {
    context.overridden.push_back(ApplyOverride(root, override_text));
  }
  Scenario scenario;
  scenario.folder = folder;
  YamlReader reader(context, root, "");
  Visit(reader, scenario);
  reader.Finish();
  const auto complain = [&](const std::string& key, std::string message) {
    context.Complain(NodeAt(root, key).Mark(), key, std::move(message));
  };
  try {
    static_cast<void>(FindModel(scenario.vehicle.model, folder));
  } catch (const InputError& error) {
    complain("vehicle.model", error.problems().front().message);
  }
  if (std::find(context.overridden.begin(), context.overridden.end(), "drive.plants") !=
      context.overridden.end()) {
    DropWhatIsNotDriven(scenario);
  }
  // Keys that could not be read would only cause follow-up complaints.
  if (context.problems.empty()) {
    for (auto& [key, message] : CrossProblems(scenario)) {
      complain(key, std::move(message));
    }
  }
  if (!context.problems.empty()) {
    std::stable_sort(context.problems.begin(), context.problems.end(),
                     [](const Problem& a, const Problem& b) {
                       return std::pair(a.line, a.column) < std::pair(b.line, b.column);
                     });
    throw InputError(context.problems);
  }
  return scenario;
}

namespace {

std::string ReadInput(const std::filesystem::path& file) {
  try {
    return ReadFile(file);
  } catch (const RunError& error) {
    throw InputError(Problem{.message = error.what()});
  }
}

}  // namespace

Scenario ReadScenario(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return ParseScenario(ReadInput(file), file.string(), file.parent_path(), overrides);
}

RenderSpec ReadRenderSpec(const std::filesystem::path& file) {
  ReaderContext context{.file = file.string(), .overridden = {}, .problems = {}};
  RenderSpec render;
  YamlReader reader(context, LoadYaml(ReadInput(file), file.string()), "");
  reader.Section("render", render);
  if (!context.problems.empty()) {
    throw InputError(context.problems);
  }
  return render;
}

void CheckScenario(const Scenario& scenario) {
  std::vector<Problem> problems;
  for (const auto& [key, message] : CrossProblems(scenario)) {
    problems.push_back({"", 0, 0, key, message});
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

StartState StartOf(const Scenario& scenario) {
  const MissionSpec& mission = scenario.mission;
  const StartSpec& given = mission.start;
  StartState start;
  if (!mission.waypoints.empty()) {
    start.pose.x = mission.waypoints.front().x();
    start.pose.y = mission.waypoints.front().y();
  }
  if (mission.waypoints.size() >= 2) {
    const Vec2 leg = mission.waypoints[1] - mission.waypoints[0];
    start.pose.yaw = std::atan2(leg.y(), leg.x());
  }
  start.pose = {given.x.value_or(start.pose.x), given.y.value_or(start.pose.y),
                given.yaw.value_or(start.pose.yaw)};
  start.speed = given.speed.value_or(mission.speed);
  start.steering = given.steering;
  return start;
}

namespace {

template <typename Variant>
std::string OneLine(Variant options) {
  YAML::Emitter out;
  out << YAML::Flow << YAML::BeginMap;
  YamlWriter writer(out);
  std::visit([&](auto& own) { Visit(writer, own); }, options);
  out << YAML::EndMap;
  const std::string text = out.c_str();  // in braces
  return text.substr(1, text.size() - 2);
}

}  // namespace

std::string OptionDefaults(const PlannerOptions& options) {
  return OneLine(options);
}

std::string OptionDefaults(const ControllerOptions& options) {
  return OneLine(options);
}

std::string ResolvedYaml(const Scenario& scenario) {
  Scenario resolved = scenario;
  const StartState start = StartOf(scenario);
  resolved.mission.start = {start.pose.x, start.pose.y, start.pose.yaw, start.speed,
                            start.steering};
  if (resolved.vehicle.model.find('/') != std::string::npos) {
    resolved.vehicle.model =
        std::filesystem::absolute(FindModel(scenario.vehicle.model, scenario.folder))
            .lexically_normal()
            .string();
  }
  YAML::Emitter out;
  out << YAML::BeginMap;
  YamlWriter writer(out);
  Visit(writer, resolved);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace trackbed
