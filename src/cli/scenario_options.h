#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "src/cli/command.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/scenario/study.h"

namespace trackbed::cli {

/// What every verb that reads scenarios can be told about them.
struct ScenarioOptions {
  std::vector<std::string> plants;
  std::vector<std::string> overrides;
  std::string seed;
  std::vector<std::string> asset_folders;
  bool quiet = false;

  /// Adds --plant, and what AddKeysTo adds.
  void AddTo(const Command& command);

  /// Adds --set, --seed, --allow-assets and --quiet, for verbs that ask for plants in their own
  /// way.
  void AddKeysTo(const Command& command);

  /// The scenario as these options change it. InputError as ReadScenario.
  [[nodiscard]] Scenario Read(const std::filesystem::path& file) const;

  /// The same of a scenario's text; `name` stands for the file in messages, `folder` is where
  /// relative paths start.
  [[nodiscard]] Scenario Parse(const std::string& yaml, const std::string& name,
                               const std::filesystem::path& folder) const;

  /// A study whose scenario these options change. InputError as ReadStudy.
  [[nodiscard]] Study ReadStudyFile(const std::filesystem::path& file) const;

 private:
  /// All of them as overrides.
  [[nodiscard]] std::vector<Override> Overrides() const;
};

/// Adds --allow-assets, which may be given several times.
void AddAllowAssets(const Command& command, std::vector<std::string>& folders);

std::vector<std::filesystem::path> Paths(const std::vector<std::string>& names);

/// What to take from folders.
enum class FolderContent { kScenarios, kScenariosAndStudies };

/// Every file in the folder `scenarios` of the data, the files of a folder before those in its
/// folders; without scenarios/validation, whose recordings are not installed.
std::vector<std::filesystem::path> ShippedScenarios(FolderContent content);

/// The file that a name on the command line means: itself if there is such a file or it has an
/// extension, else the scenario or study of that name that comes with Trackbed: "three_turns",
/// "studies/robustness" or "robustness". InputError with the nearest name when there is none, and
/// when there are several.
std::filesystem::path FindScenario(const std::filesystem::path& name);

/// The scenario files that `paths` name, each once: files as FindScenario finds them,
/// folders by the *.yaml and
/// *.yml in them and their folders, the files of a folder before those of its folders, sorted.
/// What is hidden (.git) and links to folders are passed by. A folder that has none stands for
/// itself, for RefuseFolder to tell of. RunError when a folder cannot be read.
std::vector<std::filesystem::path> ScenarioFiles(const std::vector<std::string>& paths,
                                                 FolderContent content);

/// InputError if `file` is a folder, which has no scenarios then.
void RefuseFolder(const std::filesystem::path& file);

}  // namespace trackbed::cli
