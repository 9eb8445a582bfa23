#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/cli/interruption.h"
#include "src/cli/scenario_options.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"

namespace trackbed::cli {

/// A scenario to run, and the output folder of the run.
struct ScenarioRun {
  Scenario scenario;
  std::filesystem::path folder;
  /// Compiled car model; null if DriveScenario must load the car.
  std::shared_ptr<const CarModel> car{};
};

/// Reads all scenario files before the first run, so that an error in the last file is found early.
/// For a single scenario file, the output folder is `out` if `out` is not empty. For several
/// scenario files, the output folder of each run is `<out>/<scenario>`. If `out` is empty, the
/// output folder is `<parent>/<scenario>`. ReadScenarioRuns throws the same errors as ReadScenario
/// and RefuseOverlapAtStart. ReadScenarioRuns also throws InputError if two runs would have the
/// same output folder, and RunError if the output folder `<scenario>` is a link or a file.
std::vector<ScenarioRun> ReadScenarioRuns(const std::vector<std::string>& files,
                                          const ScenarioOptions& options, const std::string& out,
                                          const std::filesystem::path& parent);

/// Throws InputError if an obstacle overlaps the car at the start of the run.
void RefuseOverlapAtStart(const std::string& file, const Scenario& scenario,
                          const VehicleParams& vehicle);

/// Calls `work` for each run, but starts no further run after Ctrl-C. After Ctrl-C, ForEachRun
/// prints the number of skipped runs to stderr. ForEachRun returns the largest exit code returned
/// by `work` for any run. ForEachRun rethrows a RunError that `work` throws, unless Ctrl-C has
/// interrupted the runs.
int ForEachRun(const std::vector<ScenarioRun>& runs,
               const std::function<int(const ScenarioRun& run)>& work);

/// A finished run whose results are not yet written, and its output folder, which this process has
/// locked.
struct DrivenScenario {
  OutputFolder folder;
  RunResult result;
  /// Object that exists for an interrupted run until the results are written.
  std::optional<FinishingResult> finishing{};
};

/// Runs the scenario with a progress bar, until the end of the run or Ctrl-C. The output folder is
/// created and locked before the run, unless the vehicle model is invalid.
DrivenScenario DriveScenario(const ScenarioRun& run, bool quiet);

}  // namespace trackbed::cli
