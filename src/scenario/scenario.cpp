#include "trackbed/scenario/scenario.h"

#include <algorithm>
#include <cmath>

#include "src/scenario/cross_check.h"
#include "src/scenario/overrides.h"
#include "src/scenario/visit.h"
#include "src/scenario/yaml_file.h"
#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

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

/// The node that a dotted key names, or the nearest one above it that is there.
YAML::Node NodeAt(const YAML::Node& root, const std::string& key) {
  YAML::Node node(root);
  for (std::size_t begin = 0; begin < key.size();) {
    const std::size_t end = std::min(key.find_first_of(".[", begin + 1), key.size());
    const bool is_index = key[begin] == '[';
    const std::size_t skip = is_index || key[begin] == '.' ? 1 : 0;
    const std::string step = key.substr(begin + skip, end - begin - skip - (is_index ? 1 : 0));
    if (is_index ? !node.IsSequence() : !node.IsMap()) {
      break;
    }
    const YAML::Node next = is_index ? node[std::stoul(step)] : node[step];
    if (!next) {
      break;
    }
    node.reset(next);
    begin = end;
  }
  return node;
}

}  // namespace

Scenario ParseScenario(const std::string& yaml, const std::string& name,
                       const std::filesystem::path& folder, const std::vector<Override>& overrides,
                       const std::vector<std::string>& cameras) {
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
  const std::string& camera = scenario.render.camera;
  if (!cameras.empty() && std::find(cameras.begin(), cameras.end(), camera) == cameras.end()) {
    complain("render.camera", "unknown " + UnknownName(camera, cameras));
  }
  if (std::find(context.overridden.begin(), context.overridden.end(), "drive.plants") !=
      context.overridden.end()) {
    DropWhatIsNotDriven(scenario);
  }
  const auto could_read = [&context](const std::string& key) { return context.Read(key); };
  for (auto& [key, message] : CrossProblems(scenario, could_read)) {
    complain(key, std::move(message));
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

Scenario ReadScenario(const std::filesystem::path& file, const std::vector<Override>& overrides,
                      const std::vector<std::string>& cameras) {
  return ParseScenario(ReadInput(file), file.string(), file.parent_path(), overrides, cameras);
}

namespace {

template <typename Struct>
Struct ReadSection(const std::filesystem::path& file, const Key& key) {
  ReaderContext context{.file = file.string(), .overridden = {}, .problems = {}};
  Struct value;
  YamlReader reader(context, LoadYaml(ReadInput(file), file.string()), "");
  reader.Section(key, value);
  if (!context.problems.empty()) {
    throw InputError(context.problems);
  }
  return value;
}

}  // namespace

RenderSpec ReadRenderSpec(const std::filesystem::path& file) {
  return ReadSection<RenderSpec>(file, kRenderSection);
}

World ReadWorld(const std::filesystem::path& file) {
  return ReadSection<World>(file, kWorldSection);
}

void CheckScenario(const Scenario& scenario) {
  std::vector<Problem> problems;
  for (const auto& [key, message] : CrossProblems(scenario, [](const auto&) { return true; })) {
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

std::string OptionDefaults(const AvoiderOptions& options) {
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
