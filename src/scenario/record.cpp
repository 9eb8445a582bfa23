#include "trackbed/scenario/record.h"

#include <utility>

#include "src/scenario/yaml_file.h"
#include "src/scenario/yaml_reader.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/plant.h"

namespace trackbed {

std::vector<std::pair<std::string, std::string>> DrivenPlantSummaries() {
  std::vector<std::pair<std::string, std::string>> summaries;
  for (const PlantEntry& entry : Plants()) {
    summaries.emplace_back(entry.name, entry.summary);
  }
  summaries.emplace_back(kRecordedPlant,
                         "not simulated: the recorded drive of the scenario's record");
  return summaries;
}

std::vector<std::string> DrivenPlantNames() {
  std::vector<std::string> names;
  for (const auto& [name, summary] : DrivenPlantSummaries()) {
    names.push_back(name);
  }
  return names;
}

LogMap ReadLogMap(const std::filesystem::path& file) {
  const YAML::Node root = LoadYaml(ReadInput(file), file.string(), "a map");
  ReaderContext context{.file = file.string(), .overridden = {}, .problems = {}};
  LogMap map;
  YamlReader reader(context, root, "");
  Visit(reader, map);
  reader.Finish();
  if (context.problems.empty()) {
    for (auto& [key, message] : LogMapProblems(map)) {
      context.AddError(NodeAt(root, key).Mark(), key, std::move(message));
    }
  }
  context.ThrowProblems();
  return map;
}

bool IsLogMap(const std::filesystem::path& file) {
  try {
    const YAML::Node root = LoadYaml(ReadInput(file), file.string(), "a map");
    return root["time"] && root["position"];
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace trackbed
