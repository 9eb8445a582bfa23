#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "src/cli/command.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/scenario/study.h"

namespace trackbed::cli {

/// Options of all verbs that read scenarios.
struct ScenarioOptions {
  std::vector<std::string> plants;
  std::vector<std::string> overrides;
  std::string seed;
  std::vector<std::string> asset_folders;
  bool quiet = false;

  /// Adds --plant and the options of AddKeysTo.
  void AddTo(const Command& command);

  /// Adds --set, --seed, --allow-assets and --quiet, for verbs with their own options for plants.
  void AddKeysTo(const Command& command);

  /// Reads a scenario and applies these options. Throws the errors of ReadScenario.
  [[nodiscard]] Scenario Read(const std::filesystem::path& file) const;

  /// As Read, for the text of a scenario. `name` stands for the file in messages; relative paths
  /// start at `folder`.
  [[nodiscard]] Scenario Parse(const std::string& yaml, const std::string& name,
                               const std::filesystem::path& folder) const;

  /// Reads a study and applies these options to its scenario. Throws the errors of ReadStudy.
  [[nodiscard]] Study ReadStudyFile(const std::filesystem::path& file) const;

 private:
  /// All options as overrides.
  [[nodiscard]] std::vector<Override> Overrides() const;
};

/// Adds --allow-assets, which may be given several times.
void AddAllowAssets(const Command& command, std::vector<std::string>& folders);

std::vector<std::filesystem::path> Paths(const std::vector<std::string>& names);

/// Kinds of files to take from folders.
enum class FolderContent { kScenarios, kScenariosAndStudies };

/// Every file in the folder `scenarios` of the data, each folder's files before its subfolders.
/// Excludes scenarios/validation, whose recordings are not installed.
std::vector<std::filesystem::path> ShippedScenarios(FolderContent content);

/// Resolves a name on the command line: an existing file or a name with an extension is taken as
/// is. Other names refer to a shipped scenario or study: "three_turns", "studies/robustness" or
/// "robustness". Throws InputError for an unknown name, with the nearest one, and for an ambiguous
/// name.
std::filesystem::path FindScenario(const std::filesystem::path& name);

/// The scenario files that `paths` name, each once: files by FindScenario, folders by all *.yaml
/// and *.yml in them, sorted, each folder's files before its subfolders. Skips hidden entries
/// (.git) and links to folders. A folder without scenarios is kept, for RefuseFolder to report.
/// Throws RunError if a folder cannot be read.
std::vector<std::filesystem::path> ScenarioFiles(const std::vector<std::string>& paths,
                                                 FolderContent content);

/// Throws InputError if `file` is a folder, which then contains no scenarios.
void RefuseFolder(const std::filesystem::path& file);

}  // namespace trackbed::cli
