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

/// Reads all files before the first run, so that a mistake in the last one is found early. The
/// output folder is `out` for a single file, else `<out>/<scenario>`, or `<parent>/<scenario>`
/// without `out`. Throws the errors of ReadScenario, and InputError if two runs would share a
/// folder.
std::vector<ScenarioRun> ReadScenarioRuns(const std::vector<std::string>& files,
                                          const ScenarioOptions& options, const std::string& out,
                                          const std::filesystem::path& parent);

/// Calls `work` for each run until Ctrl-C, then prints the number of skipped runs to stderr.
/// Returns the worst exit code. Rethrows a RunError of `work`, except that of an interrupted film.
int ForEachRun(const std::vector<ScenarioRun>& runs,
               const std::function<int(const ScenarioRun& run)>& work);

/// A run not yet written, and its output folder, locked by this process.
struct DrivenScenario {
  OutputFolder folder;
  RunResult result;
  std::optional<FinishingResult> finishing{};  ///< of an interrupted run, until it is written
};

/// Runs the scenario with a progress bar until Ctrl-C. Creates and locks the folder before the run,
/// but not if the model is invalid.
DrivenScenario DriveScenario(const ScenarioRun& run, bool quiet);

}  // namespace trackbed::cli
