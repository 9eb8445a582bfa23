#include "trackbed/analysis/run.h"

#include <fmt/color.h>
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "src/cli/film_of_run.h"
#include "src/cli/progress_bar.h"
#include "src/cli/scenario_options.h"
#include "src/cli/verbs.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::vector<std::string> files;
  std::string out;
  bool video = false;
  ScenarioOptions scenario;
};

void PrintSummary(const RunResult& result) {
  for (const PlantMetrics& plant : result.metrics) {
    fmt::print("  {:<10} {} after {:.2f} s, {:.2f} m", plant.plant, ToString(plant.status),
               plant.time, plant.distance);
    if (plant.tracking) {
      const TrackingMetrics& tracking = *plant.tracking;
      fmt::print("; cross-track max {:.4f} m, rms {:.4f} m; {:.4f} m from the goal",
                 tracking.cross_track_max, tracking.cross_track_rms, tracking.goal_distance);
    }
    fmt::print("\n");
  }
  for (const PlantComparison& between : result.comparisons) {
    fmt::print("  {} - {}: position max {:.4f} m, heading max {:.4f} rad\n", between.first,
               between.second, between.position_max, between.heading_max);
  }
  for (const std::string& failure : result.verdict.failures) {
    fmt::print("  {}\n", failure);
  }
}

int RunOne(const std::string& file, const fs::path& folder, const RunOptions& options) {
  const Scenario scenario = options.scenario.Read(file);
  const fs::path out = options.out.empty() ? fs::path("out") / scenario.name : folder;
  MakeFolder(out);  // before the work, not after it

  std::unique_ptr<ProgressBar> bar;
  const RunResult result =
      RunMission(scenario, {.drive = [&](const std::string& plant) {
                   bar.reset();
                   bar = std::make_unique<ProgressBar>(fmt::format("{} {}", scenario.name, plant),
                                                       options.scenario.quiet);
                   return DriveHooks{.progress = [&](double fraction) { bar->Show(fraction); },
                                     .interrupted = [] { return interrupted.load(); }};
                 }});
  bar.reset();
  WriteRunFolder(result, out);
  if (options.video && !result.interrupted && result.plan.ok()) {
    const RenderSpec& render = scenario.render;
    FilmRun(out, out / "video.mp4",
            {.width = render.width,
             .height = render.height,
             .fps = render.fps,
             .camera = render.camera},
            options.scenario.quiet);
  }
  if (!options.scenario.quiet) {
    fmt::print("{}: {}, in {}\n", scenario.name,
               result.interrupted      ? "interrupted"
               : result.verdict.passed ? "passed"
                                       : "FAILED",
               out.string());
    PrintSummary(result);
  }
  return result.interrupted ? kInterrupted : result.verdict.passed ? kOk : kFailedExpectations;
}

}  // namespace

void AddRun(CLI::App& command, int& exit_code) {
  const auto options = std::make_shared<RunOptions>();
  command.add_option("files", options->files, "Scenario files")->required()->type_name("FILE...");
  command
      .add_option("-o,--out", options->out,
                  "Folder of the run (default: out/<scenario>); of several files: parent of one "
                  "folder each")
      ->type_name("DIR");
  options->scenario.AddTo(command);
  command.add_flag("--video", options->video, "Film the run: video.mp4 in its folder");
  command.callback([options, &exit_code] {
    for (const std::string& file : options->files) {
      const fs::path folder = options->files.size() == 1
                                  ? fs::path(options->out)
                                  : fs::path(options->out) / fs::path(file).stem();
      const int code = RunOne(file, folder, *options);
      exit_code = std::max(exit_code, code);
      if (code == kInterrupted) {
        return;
      }
    }
  });
}

}  // namespace trackbed::cli
