#include "src/cli/scenario_options.h"

#include <fmt/format.h>

#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/run.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed::cli {

namespace fs = std::filesystem;

void AddAllowAssets(const Command& command, std::vector<std::string>& folders) {
  command
      .AddOption("--allow-assets", folders,
                 "Let models and scenarios name files in this folder, too, beside those in their "
                 "own")
      .OneWord()
      .TypeName("DIR");
}

void AddJobs(const Command& command, int& jobs, const std::string& what) {
  command.AddOption("-j,--jobs", jobs, what + " (default: one per hardware thread)")
      .Range(1, 1000)
      .TypeName("N");
}

std::vector<fs::path> Paths(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

void ScenarioOptions::AddTo(const Command& command) {
  command.AddOption("--plant", plants, "Run these plants instead of the scenario's")
      .TypeName("PLANT...");
  AddKeysTo(command);
}

void ScenarioOptions::AddKeysTo(const Command& command) {
  command.AddOption("--set", overrides, "Override keys of the scenario, such as mission.speed=2")
      .TypeName("KEY=VALUE...");
  command.AddOption("--seed", seed, "Override the scenario's seed").TypeName("N");
  AddAllowAssets(command, asset_folders);
  command.AddFlag("-q,--quiet", quiet, "Print errors only");
}

std::vector<Override> ScenarioOptions::Overrides() const {
  std::vector<Override> all = overrides;
  if (!plants.empty()) {
    all.push_back(fmt::format("drive.plants=[{}]", fmt::join(plants, ", ")));
  }
  if (!seed.empty()) {
    all.push_back("seed=" + seed);
  }
  return all;
}

Scenario ScenarioOptions::Read(const fs::path& file) const {
  return LoadScenario(FindScenario(file), Overrides(), Paths(asset_folders));
}

Scenario ScenarioOptions::Parse(const std::string& yaml, const std::string& name,
                                const fs::path& folder) const {
  return ParseScenario(yaml, name, folder, Overrides(), PossibleMetrics, Paths(asset_folders));
}

Study ScenarioOptions::ReadStudyFile(const fs::path& file) const {
  return ReadStudy(FindScenario(file), Overrides(), PossibleMetrics, Paths(asset_folders));
}

}  // namespace trackbed::cli
