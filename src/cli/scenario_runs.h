#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/cli/scenario_options.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

namespace trackbed::cli {

/// A scenario, and the folder that its run is to be written to.
struct ScenarioRun {
  Scenario scenario;
  std::filesystem::path folder;
};

/// Reads every file before anything is driven: the last one's mistake should not cost a run.
/// Folders are `out`, if it is given and there is one file; else `<out>/<scenario>`, or without
/// `out` `<parent>/<scenario>`. InputError as ReadScenario, and when two would write to one folder.
std::vector<ScenarioRun> ReadScenarioRuns(const std::vector<std::string>& files,
                                          const ScenarioOptions& options, const std::string& out,
                                          const std::filesystem::path& parent);

/// Works through the runs until Ctrl-C; then says on stderr how many were not begun. Gives back the
/// worst exit code. A RunError of `work` is thrown on, but for that of an interrupted film.
int ForEachRun(const std::vector<ScenarioRun>& runs,
               const std::function<int(const ScenarioRun& run)>& work);

/// A run that is yet to be written to its folder, which is this process's alone.
struct DrivenScenario {
  OutputFolder folder;
  RunResult result;
};

/// Runs the scenario with a progress bar until Ctrl-C. The folder is made and locked before the
/// work, not after it, and not at all for a model that cannot be used.
DrivenScenario DriveScenario(const ScenarioRun& run, bool quiet);

}  // namespace trackbed::cli
