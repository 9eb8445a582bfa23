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

void PrintManoeuvre(const ManoeuvreMetrics& manoeuvre) {
  fmt::print("    {}{}\n", manoeuvre.method,
             !manoeuvre.passed   ? ""
             : *manoeuvre.passed ? ": passed"
                                 : ": NOT passed");
  for (const auto& [name, value] : manoeuvre.values) {
    fmt::print("    {:<36} {:>10.4g}\n", name, value);
  }
  if (!manoeuvre.missing.empty()) {
    fmt::print("    {}\n", manoeuvre.missing);
  }
}

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
    if (plant.manoeuvre) {
      PrintManoeuvre(*plant.manoeuvre);
    }
  }
  for (const PlantComparison& between : result.comparisons) {
    fmt::print("  {} - {}: position max {:.4f} m, heading max {:.4f} rad\n", between.first,
               between.second, between.position_max, between.heading_max);
  }
  for (const std::string& failure : result.verdict.failures) {
    fmt::print("  {}\n", failure);
  }
  for (const std::string& note : result.verdict.notes) {
    fmt::print("  {}\n", note);
  }
}

int RunOne(const Scenario& scenario, const fs::path& out, const RunOptions& options) {
  static_cast<void>(LoadCar(scenario));  // a model that cannot be used leaves no folder behind
  MakeFolder(out);                       // before the work, not after it

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
    FilmRun(out, out / kVideoName,
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
    // Read everything before driving anything: the last file's mistake should not cost a run.
    std::vector<std::pair<Scenario, fs::path>> runs;
    for (const std::string& file : options->files) {
      Scenario scenario = options->scenario.Read(file);
      const fs::path parent = options->out.empty() ? fs::path("out") : fs::path(options->out);
      const fs::path out =
          options->out.empty() || options->files.size() > 1 ? parent / scenario.name : parent;
      for (const auto& [other, folder] : runs) {
        if (folder == out) {
          throw InputError(
              Problem{file, 0, 0, "name",
                      fmt::format("'{}' is the name of an earlier file too; both would write to {}",
                                  scenario.name, out.string())});
        }
      }
      if (options->video) {
        CheckFilmName(out / kVideoName);
      }
      runs.emplace_back(std::move(scenario), out);
    }
    for (const auto& [scenario, out] : runs) {
      const int code = RunOne(scenario, out, *options);
      exit_code = std::max(exit_code, code);
      if (code == kInterrupted) {
        return;
      }
    }
  });
}

}  // namespace trackbed::cli
