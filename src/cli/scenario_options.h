#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "src/cli/command.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/scenario/scenario_files.h"
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

/// Adds the option --jobs, the number of parallel jobs; `jobs` is 0 if the user does not give the
/// option. The text `what` describes the jobs in the help, such as "Runs in parallel".
void AddJobs(const Command& command, int& jobs, const std::string& what);

std::vector<std::filesystem::path> Paths(const std::vector<std::string>& names);

}  // namespace trackbed::cli
