#include "trackbed/analysis/run.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "src/cli/film_of_run.h"
#include "src/cli/run_summary.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/hash.h"
#include "trackbed/report/report.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::vector<std::string> files;
  std::string out;
  bool video = false;
  std::string gl = FilmOptions{}.gl;
  bool report = false;
  bool mcap = false;
  std::string sweep;
  std::optional<int> row;
  ScenarioOptions scenario;
};

/// Changes the options of `run` to repeat one row of a study. The scenario is the study's, with the
/// row's settings applied before all other overrides.
void TakeRow(RunOptions& options) {
  const fs::path folder = options.sweep;
  const SweepRecords records(folder / run_folder::kSweepRecords);
  const JsonValue header = records.Header();
  const fs::path scenario = header.At("scenario").Text();
  const std::optional<JsonValue> inputs = header.Find("inputs");
  const std::optional<JsonValue> sum = inputs ? inputs->Find("scenario") : std::nullopt;
  const std::string hash = sum ? sum->Text() : "";
  if (!hash.empty() && Sha256(ReadFile(scenario)) != hash) {
    throw InputError(
        Problem{.file = scenario.string(),
                .message = "has changed since the study in " + folder.string() + " was run"});
  }
  std::vector<Override> overrides = OverridesOfRow(records, static_cast<std::size_t>(*options.row));
  overrides.insert(overrides.end(), options.scenario.overrides.begin(),
                   options.scenario.overrides.end());
  options.scenario.overrides = std::move(overrides);
  options.files = {scenario.string()};
}

int RunOne(const ScenarioRun& run, const RunOptions& options) {
  const Scenario& scenario = run.scenario;
  const fs::path& out = run.folder;
  const auto [folder, result, finishing] = DriveScenario(run, options.scenario.quiet);
  WriteRunFolder(result, folder, {.mcap = options.mcap});
  if (options.scenario.quiet) {
    PrintFailures(result);
  } else {
    PrintSummary(result, out);
  }
  if (options.video && !result.interrupted && result.plan.ok()) {
    FilmRun(out, out / run_folder::kVideo, FilmOptionsOf(scenario.render, options.gl),
            options.scenario.quiet);
  }
  if (options.report && !result.interrupted) {
    WriteReport({out}, out / run_folder::kReport);
  }
  return ExitCodeOf(result);
}

}  // namespace

void AddRun(const Command& command) {
  const auto options = std::make_shared<RunOptions>();
  const Option files = command.AddPositional("files", options->files, "Scenario files")
                           .Required()
                           .TypeName("SCENARIO...");
  command
      .AddOption(
          "-o,--out", options->out,
          "Output folder (default: out/<scenario>); with several scenarios, one subfolder each")
      .TypeName("DIR");
  options->scenario.AddTo(command);
  command.AddFlag("--video", options->video, "Also render video.mp4 in the run folder");
  AddGlOption(command, options->gl);
  command.AddFlag("--report", options->report,
                  "Also write report.html in the run folder, including the video if present");
  command.AddFlag("--mcap", options->mcap, "Also write run.mcap (Foxglove) in the run folder");
  command
      .AddOption("--from-sweep", options->sweep,
                 "Run what a row of a study in this folder ran, instead of scenario files")
      .InsteadOf(files)
      .TypeName("DIR");
  command.AddOption("--row", options->row, "The row, from 0").Range(0, 1'000'000'000).TypeName("N");
  command.AddExample("Drive a shipped scenario; the results are in out/three_turns",
                     "trackbed run three_turns");
  command.AddExample("The same at another speed, with a page and a 3-D replay to open in a browser",
                     "trackbed run three_turns --set mission.speed=2 --report --out faster");
  command.OnRun([options] {
    if (options->sweep.empty() != !options->row) {
      throw InputError(Problem{.message = "give both --from-sweep DIR and --row N, or neither"});
    }
    if (options->row) {
      TakeRow(*options);
    }
    const std::vector<ScenarioRun> runs =
        ReadScenarioRuns(options->files, options->scenario, options->out, "out");
    if (options->video) {
      CheckGl(options->gl);
      for (const ScenarioRun& run : runs) {
        CheckFilmName(run.folder / run_folder::kVideo);
      }
    }
    return ForEachRun(runs, [&](const ScenarioRun& run) { return RunOne(run, *options); });
  });
}

}  // namespace trackbed::cli
