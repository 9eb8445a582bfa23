#include "src/cli/scenario_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "src/cli/output_file.h"
#include "src/cli/progress_bar.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/foreign_files.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"
#include "trackbed/drive/start_overlap.h"
#include "trackbed/sim/model_notes.h"

namespace trackbed::cli {

namespace fs = std::filesystem;

std::vector<ScenarioRun> ReadScenarioRuns(const std::vector<std::string>& files,
                                          const ScenarioOptions& options, const std::string& out,
                                          const fs::path& parent) {
  std::vector<ScenarioRun> runs;
  for (const std::string& file : files) {
    Scenario scenario = options.Read(file);
    auto car = std::make_shared<const CarModel>(LoadCar(scenario));
    RefuseOverlapAtStart(file, scenario, car->params());
    if (files.size() > 1) {
      car.reset();  // do not keep the cars of many scenarios in memory
    }
    const fs::path folder = files.size() > 1 && !out.empty()
                                ? FolderBelow(out, scenario.name)
                                : OutputFolderOf(out, scenario.name, parent);
    for (const ScenarioRun& other : runs) {
      if (other.folder == folder) {
        throw InputError(
            Problem{file, 0, 0, "name",
                    fmt::format("the scenario name '{}' is used twice; both would write to {}",
                                scenario.name, folder.string())});
      }
    }
    runs.push_back({std::move(scenario), folder, std::move(car)});
  }
  return runs;
}

void RefuseOverlapAtStart(const std::string& file, const Scenario& scenario,
                          const VehicleParams& vehicle) {
  if (std::string why = StartOverlap(scenario, vehicle); !why.empty()) {
    throw InputError(Problem{.file = file, .key = "mission.start", .message = std::move(why)});
  }
}

int ForEachRun(const std::vector<ScenarioRun>& runs,
               const std::function<int(const ScenarioRun& run)>& work) {
  int worst = kOk;
  for (std::size_t i = 0; i < runs.size() && worst != kInterrupted; ++i) {
    try {
      worst = std::max(worst, work(runs[i]));
    } catch (const RunError& error) {
      if (!interrupted) {
        throw;
      }
      PrintTo(stderr, "{}\n", Lines{error.what()});
      worst = kInterrupted;
    }
    const std::size_t left = runs.size() - i - 1;
    if (worst == kInterrupted && left > 0) {
      PrintTo(stderr, "interrupted: {} of {} scenarios not run\n", left, runs.size());
    }
  }
  return worst;
}

DrivenScenario DriveScenario(const ScenarioRun& run, bool quiet) {
  const auto loaded = run.car ? run.car : std::make_shared<const CarModel>(LoadCar(run.scenario));
  const CarModel& car = *loaded;
  if (!quiet) {
    for (const std::string& note : NotesOnModel(car)) {
      PrintTo(stderr, "note: {}: {}\n", car.file(), note);
    }
  }
  std::vector<std::string> names = run_folder::AllNames();
  for (const SceneAsset& asset : car.scene().assets) {
    names.push_back(asset.name);
  }
  OutputFolder folder(run.folder, names);
  std::unique_ptr<ProgressBar> bar;
  std::optional<FinishingResult> finishing;
  RunResult result = RunScenario(
      run.scenario, car, {.drive = [&](const std::string& plant) {
        bar.reset();
        bar = std::make_unique<ProgressBar>(fmt::format("{} {}", run.scenario.name, plant), quiet);
        return DriveHooks{.progress = [&](double fraction) { bar->Show(fraction); },
                          .interrupted =
                              [&] {
                                if (interrupted && !finishing) {
                                  finishing.emplace();
                                }
                                return interrupted.load();
                              }};
      }});
  return {std::move(folder), std::move(result), std::move(finishing)};
}

}  // namespace trackbed::cli
