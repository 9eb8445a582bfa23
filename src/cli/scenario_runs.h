#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/cli/interruption.h"
#include "src/cli/scenario_options.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

namespace trackbed::cli {

/// A scenario and the output folder of its run.
struct ScenarioRun {
  Scenario scenario;
  std::filesystem::path folder;
};

/// Reads all files before the first run, so that an error in the last file is found early. For a
/// single file, the output folder is `out`. For several files, the output folder is
/// `<out>/<scenario>`, or `<parent>/<scenario>` without `out`. Throws the errors of ReadScenario.
/// Throws InputError if two runs would share a folder.
std::vector<ScenarioRun> ReadScenarioRuns(const std::vector<std::string>& files,
                                          const ScenarioOptions& options, const std::string& out,
                                          const std::filesystem::path& parent);

/// Calls `work` for each run until Ctrl-C. Finally, ForEachRun prints the number of skipped runs to
/// stderr. ForEachRun returns the worst exit code. A RunError of `work` is rethrown, except that of
/// an interrupted film.
int ForEachRun(const std::vector<ScenarioRun>& runs,
               const std::function<int(const ScenarioRun& run)>& work);

/// A run that is not yet written, and its output folder, which this process has locked.
struct DrivenScenario {
  OutputFolder folder;
  RunResult result;
  std::optional<FinishingResult> finishing{};  ///< set for an interrupted run until it is written
};

/// Runs the scenario with a progress bar until its end or Ctrl-C. The folder is created and locked
/// before the run, but not if the model is invalid.
DrivenScenario DriveScenario(const ScenarioRun& run, bool quiet);

}  // namespace trackbed::cli
