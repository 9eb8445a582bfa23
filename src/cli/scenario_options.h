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

  /// Adds --set, --seed, --allow-assets and --quiet. AddKeysTo suits verbs with their own options
  /// for plants.
  void AddKeysTo(const Command& command);

  /// Reads a scenario and applies the options of the command line. Read() throws the errors of
  /// ReadScenario.
  [[nodiscard]] Scenario Read(const std::filesystem::path& file) const;

  /// Same as Read, for the text of a scenario. Messages use `name` as the file's name; relative
  /// paths start at `folder`.
  [[nodiscard]] Scenario Parse(const std::string& yaml, const std::string& name,
                               const std::filesystem::path& folder) const;

  /// Reads a study and applies the options of the command line to its scenario. ReadStudyFile
  /// throws the errors of ReadStudy.
  [[nodiscard]] Study ReadStudyFile(const std::filesystem::path& file) const;

 private:
  /// Converts all options to overrides of scenario keys.
  [[nodiscard]] std::vector<Override> Overrides() const;
};

/// Adds the option --allow-assets, which may be given several times.
void AddAllowAssets(const Command& command, std::vector<std::string>& folders);

std::vector<std::filesystem::path> Paths(const std::vector<std::string>& names);

/// Kinds of files that verbs take from folders.
enum class FolderContent { kScenarios, kScenariosAndStudies };

/// All files in the folder `scenarios` of the data; the files of a folder precede its subfolders.
/// The list of shipped files excludes scenarios/validation, whose recordings are not installed.
std::vector<std::filesystem::path> ShippedScenarios(FolderContent content);

/// Resolves a file name on the command line. An existing file, or a name with an extension, is
/// returned unchanged. Names of other forms are those of a shipped scenario or study:
/// "three_turns", "studies/robustness" or "robustness". Throws InputError for an ambiguous name.
/// FindScenario throws InputError with the nearest name for an unknown name.
std::filesystem::path FindScenario(const std::filesystem::path& name);

/// The scenario files that `paths` name, each once. Names of files are resolved by FindScenario. A
/// folder stands for all *.yaml and *.yml in it, sorted, with files before subfolders.
/// ScenarioFiles skips hidden entries (.git) and links to folders. A folder without scenarios stays
/// in the list, so that RefuseFolder reports it. ScenarioFiles throws RunError if a folder cannot
/// be read.
std::vector<std::filesystem::path> ScenarioFiles(const std::vector<std::string>& paths,
                                                 FolderContent content);

/// Throws InputError if `file` is a folder without scenarios.
void RefuseFolder(const std::filesystem::path& file);

}  // namespace trackbed::cli
