#include "trackbed/analysis/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "src/cli/film_of_run.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/hash.h"
#include "trackbed/report/names.h"
#include "trackbed/report/report.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::vector<std::string> files;
  std::string out;
  bool video = false;
  bool report = false;
  bool mcap = false;
  std::string sweep;
  std::optional<int> row;
  ScenarioOptions scenario;
};

/// The scenario of a row becomes the one to run, with what the row sets before other overrides.
void TakeRow(RunOptions& options) {
  const fs::path folder = options.sweep;
  const SweepRecords records(folder / run_folder::kSweepRecords);
  const fs::path scenario = records.header().at("scenario").get<std::string>();
  const std::string hash = records.header()
                               .value("inputs", nlohmann::ordered_json::object())
                               .value("scenario", std::string());
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

void PrintManeuver(const ManeuverMetrics& maneuver) {
  fmt::print("    {}{}, evaluated from {:.2f} s to {:.2f} s of the run\n", maneuver.method,
             !maneuver.passed   ? ""
             : *maneuver.passed ? ": " + Toned(Tone::kGood, "passed")
                                : ": " + Toned(Tone::kBad, "FAILED"),
             maneuver.begin, maneuver.end);
  for (const auto& [path, value] : maneuver.values) {
    const ShownName name = NameOfMetric("maneuver." + path);
    constexpr std::string_view kGroup = "Maneuver: ";
    std::string text =
        fmt::format("    {:<44} {:>10.4g}{}",
                    name.label.starts_with(kGroup) ? name.label.substr(kGroup.size()) : name.label,
                    value, name.unit.empty() ? "" : " " + name.unit);
    if (name.limit) {
      const bool at_most = name.limit->relation == StandardLimit::Relation::kAtMost;
      text += Toned(
          name.limit->Met(value) ? Tone::kGood : Tone::kBad,
          fmt::format(" ({} {:.4g} to pass)", at_most ? "at most" : "at least", name.limit->bound));
    }
    fmt::print("{}\n", text);
  }
  if (!maneuver.missing.empty()) {
    fmt::print("    {}\n", maneuver.missing);
  }
}

/// "rolled over".
std::string InWords(DriveStatus status) {
  std::string words = ToString(status);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

void PrintSummary(const RunResult& result) {
  for (const PlantMetrics& plant : result.metrics) {
    fmt::print("  {:<10} ", plant.plant);
    if (plant.status == DriveStatus::kCollided) {
      fmt::print("{} at {:.2f} s, followed until {:.2f} s, {:.2f} m", InWords(plant.status),
                 plant.contact_t, plant.time, plant.distance);
    } else {
      fmt::print("{} {} {:.2f} s, {:.2f} m", InWords(plant.status),
                 plant.status == DriveStatus::kRolledOver ? "at" : "after", plant.time,
                 plant.distance);
    }
    if (plant.tracking) {
      const TrackingMetrics& tracking = *plant.tracking;
      fmt::print("; cross-track error max {:.4f} m, rms {:.4f} m; goal distance {:.4f} m",
                 tracking.cross_track_max, tracking.cross_track_rms, tracking.goal_distance);
    }
    fmt::print("\n");
    if (plant.maneuver) {
      PrintManeuver(*plant.maneuver);
    }
  }
  for (const PlantComparison& between : result.comparisons) {
    fmt::print("  {} - {}: position max {:.4f} m, heading max {:.4f} rad\n", between.first,
               between.second, between.position.max, between.heading.max);
  }
  for (const std::string& failure : result.verdict.failures) {
    fmt::print("  {}\n", failure);
  }
  for (const std::string& note : result.verdict.notes) {
    fmt::print("  {}\n", note);
  }
}

int RunOne(const ScenarioRun& run, const RunOptions& options) {
  const Scenario& scenario = run.scenario;
  const fs::path& out = run.folder;
  const auto [folder, result] = DriveScenario(run, options.scenario.quiet);
  WriteRunFolder(result, folder, {.mcap = options.mcap});
  if (!options.scenario.quiet) {
    fmt::print("{}: {}, in {}\n", scenario.name,
               result.interrupted       ? Toned(Tone::kDoubtful, "interrupted")
               : !result.verdict.judged ? "finished, no expectations"
               : result.verdict.passed  ? Toned(Tone::kGood, "passed")
                                        : Toned(Tone::kBad, "FAILED"),
               out.string());
    PrintSummary(result);
    std::fflush(stdout);  // a film takes its time, and may find no room
  }
  if (options.video && !result.interrupted && result.plan.ok()) {
    const RenderSpec& render = scenario.render;
    FilmRun(out, out / run_folder::kVideo,
            {.width = render.width,
             .height = render.height,
             .fps = render.fps,
             .camera = render.camera},
            options.scenario.quiet);
  }
  if (options.report && !result.interrupted) {
    WriteReport({out}, out / run_folder::kReport);
  }
  const bool failed = result.verdict.judged && !result.verdict.passed;
  return result.interrupted ? kInterrupted : failed ? kFailedExpectations : kOk;
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
    for (const ScenarioRun& run : runs) {
      if (options->video) {
        CheckFilmName(run.folder / run_folder::kVideo);
      }
    }
    return ForEachRun(runs, [&](const ScenarioRun& run) { return RunOne(run, *options); });
  });
}

}  // namespace trackbed::cli
