#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "src/cli/command.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/scenario/study.h"

namespace trackbed::cli {

/// Command line options that are common to all verbs that read scenarios.
struct ScenarioOptions {
  std::vector<std::string> plants;
  std::vector<std::string> overrides;
  std::string seed;
  std::vector<std::string> asset_folders;
  bool quiet = false;

  /// Adds the option --plant and the options that AddKeysTo adds.
  void AddTo(const Command& command);

  /// Adds the options --set, --seed, --allow-assets and --quiet. A verb that defines its own
  /// options for plants calls AddKeysTo instead of AddTo.
  void AddKeysTo(const Command& command);

  /// Reads a scenario file and applies the options of the command line. Read() throws the same
  /// errors as ReadScenario.
  [[nodiscard]] Scenario Read(const std::filesystem::path& file) const;

  /// Reads a scenario from text instead of a file, and applies the options of the command line.
  /// Error messages use `name` as the file name. Relative paths in the scenario are relative to
  /// `folder`.
  [[nodiscard]] Scenario Parse(const std::string& yaml, const std::string& name,
                               const std::filesystem::path& folder) const;

  /// Reads a study file and applies the options of the command line to the study's scenario.
  /// ReadStudyFile throws the same errors as ReadStudy.
  [[nodiscard]] Study ReadStudyFile(const std::filesystem::path& file) const;

 private:
  /// Converts all command line options to overrides of scenario keys.
  [[nodiscard]] std::vector<Override> Overrides() const;
};

/// Adds the option --allow-assets, which may be given several times.
void AddAllowAssets(const Command& command, std::vector<std::string>& folders);

std::vector<std::filesystem::path> Paths(const std::vector<std::string>& names);

/// Kinds of files for which a verb searches a folder.
enum class FolderContent { kScenarios, kScenariosAndStudies };

/// Returns the scenario files (and study files, if `content` asks for studies) that are shipped
/// with Trackbed. The files of each folder precede the files of its subfolders. The list excludes
/// scenarios/validation, whose recordings are not installed.
std::vector<std::filesystem::path> ShippedScenarios(FolderContent content);

/// Finds the scenario file or study file that a name on the command line refers to. FindScenario
/// returns an existing file, or a name with an extension, unchanged. Any other name refers to a
/// shipped scenario or study, such as "three_turns", "studies/robustness" or "robustness". Throws
/// InputError if several shipped files match the name. For an unknown name, FindScenario throws
/// InputError that suggests the most similar name.
std::filesystem::path FindScenario(const std::filesystem::path& name);

/// Returns the scenario files that `paths` name, without duplicates. Each path that is not a folder
/// is resolved by FindScenario. A folder is replaced by all its *.yaml and *.yml files, sorted,
/// with files before subfolders. ScenarioFiles skips hidden files and folders (.git) and links to
/// folders. If a folder contains no scenarios, the returned list contains the folder itself, so
/// that RefuseFolder can report the folder. ScenarioFiles throws RunError if a folder cannot be
/// read.
std::vector<std::filesystem::path> ScenarioFiles(const std::vector<std::string>& paths,
                                                 FolderContent content);

/// Throws InputError if `file` is a folder without scenarios.
void RefuseFolder(const std::filesystem::path& file);

}  // namespace trackbed::cli
