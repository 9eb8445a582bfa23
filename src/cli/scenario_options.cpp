#include "src/cli/scenario_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "trackbed/analysis/metrics.h"
#include "trackbed/core/error.h"
#include "trackbed/render/film.h"

namespace trackbed::cli {

namespace fs = std::filesystem;

namespace {

/// The cameras are a room below the scenario's.
std::vector<std::string> CameraNames() {
  std::vector<std::string> names;
  for (const FilmChoice& camera : Cameras()) {
    names.push_back(camera.name);
  }
  return names;
}

}  // namespace

void ScenarioOptions::AddTo(CLI::App& command) {
  command.add_option("--plant", plants, "Drive these plants instead of the scenario's")
      ->type_name("NAME...");
  AddKeysTo(command);
}

void ScenarioOptions::AddKeysTo(CLI::App& command) {
  command.add_option("--set", overrides, "Replace keys of the scenario, such as mission.speed=2")
      ->type_name("KEY=VALUE...");
  command.add_option("--seed", seed, "Replace the scenario's seed")->type_name("N");
  command.add_flag("-q,--quiet", quiet, "Print errors only");
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
  return ReadScenario(file, Overrides(), CameraNames(), PossibleMetrics);
}

Study ScenarioOptions::ReadStudyFile(const fs::path& file) const {
  return ReadStudy(file, Overrides(), CameraNames(), PossibleMetrics);
}

std::vector<fs::path> ScenarioFiles(const std::vector<std::string>& paths) {
  std::vector<fs::path> files;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      files.emplace_back(path);
      continue;
    }
    const std::size_t before = files.size();
    for (const auto& entry : fs::directory_iterator(path)) {
      if (entry.path().extension() == ".yaml") {
        files.push_back(entry.path());
      }
    }
    if (files.size() == before) {
      throw InputError(Problem{.file = path, .message = "the folder has no scenarios (*.yaml)"});
    }
    std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
  }
  return files;
}

}  // namespace trackbed::cli
