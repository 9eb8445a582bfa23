#include "trackbed/falsify/falsify.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "src/cli/film_of_run.h"
#include "src/cli/progress_bar.h"
#include "src/cli/scenario_options.h"
#include "src/cli/sweep_folders.h"
#include "src/cli/text_columns.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/falsify/counterexample.h"
#include "trackbed/report/report.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

// What the manifest calls the files beside those of a study.
constexpr const char* kFalsification = "falsification";

struct FalsifyVerbOptions {
  std::string file;
  std::string out;
  std::optional<double> time;
  bool restart = false;
  bool video = false;
  std::string gl = FilmOptions{}.gl;
  bool report = false;
  int jobs = 0;  // 0: as many as the machine runs threads
  ScenarioOptions scenario;
};

/// The records as a table without gaps: what was planned is more than what was run.
SweepSummary WriteTable(const SweepRecords& records, const OutputFolder& folder) {
  nlohmann::ordered_json header = records.header();
  header["rows_expected"] = records.count();
  SweepRecords whole = SweepRecords::InMemory(header);
  for (std::size_t row = 0; row < records.count(); ++row) {
    whole.Append(row, records.Read(row));
  }
  return WriteSweep(whole, {}, folder);
}

/// The run folder of the counterexample, and the scenario for a test suite in it.
void WriteCounterexample(const FalsifyResult& result, const CheckedSearch& search,
                         const fs::path& out, const FalsifyVerbOptions& options) {
  const RunResult run = RunCounterexample(result, search);
  const OutputFolder folder(out);
  WriteRunFolder(run, folder);
  const Regression regression =
      MakeRegression(run, search.study.name + "_" + run_folder::kCounterexample);
  {
    ResultWriter writer(folder);
    writer.Add(run_folder::kCounterexampleYaml, RegressionYaml(regression, run));
    writer.Commit(run_folder::kCounterexample, {});
  }
  if (options.video && run.plan.ok()) {
    const RenderSpec& render = run.scenario.render;
    FilmRun(out, out / run_folder::kVideo,
            {.width = render.width,
             .height = render.height,
             .fps = render.fps,
             .camera = render.camera,
             .gl = options.gl,
             .title = search.study.name + ": " + run_folder::kCounterexample,
             .note = result.counterexample->reason},
            options.scenario.quiet);
  }
  if (options.report) {
    WriteReport({out}, out / run_folder::kReport);
  }
}

/// "18.2", or a dash.
std::string Cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.5g}", *value) : "-";
}

/// "16.4 to 18.2", with the ends of the range where it passes up to them.
std::string ReachText(const SearchSpace& space, std::size_t i, const KeyMargin& margin) {
  const auto end = [&](const std::optional<ReachAlone>& alone) {
    return alone ? space.Value(i, alone->passes) : space.keys()[i].nominal;
  };
  if (!margin.down && !margin.up) {
    return "-";
  }
  return fmt::format("{:.5g} to {:.5g}", end(margin.down), end(margin.up));
}

void PrintMargins(const FalsifyResult& result, const CheckedSearch& search) {
  const Shrunk& shrunk = result.shrunk;
  if (shrunk.keys.empty()) {
    return;  // it was not made smaller
  }
  const SearchSpace& space = search.space;
  std::vector<TextColumn> columns{{{"key"}, "", {}},
                                  {{"nominal"}, "", {}},
                                  {{"fails", "at"}, "", {}},
                                  {{"holds", "up", "to"}, "", {}},
                                  {{"alone", "holds"}, "", {}},
                                  {{"sensitivity"}, "", {}}};
  for (std::size_t i = 0; i < shrunk.keys.size(); ++i) {
    const KeyMargin& margin = shrunk.keys[i];
    const std::vector<std::string> texts{
        space.keys()[i].key,
        Cell(space.keys()[i].nominal),
        Cell(space.Value(i, shrunk.point[i])),
        Cell(margin.holds_to ? std::optional(space.Value(i, *margin.holds_to)) : std::nullopt),
        ReachText(space, i, margin),
        Cell(margin.sensitivity)};
    for (std::size_t column = 0; column < columns.size(); ++column) {
      columns[column].texts.push_back(texts[column]);
    }
  }
  TextColumns table;
  for (TextColumn& column : columns) {
    table.Add(std::move(column));
  }
  for (const std::string& line : table.Lines()) {
    fmt::print("{}\n", line);
  }
}

/// Removes the run folder of an earlier search's counterexample.
void RemoveCounterexample(const fs::path& folder) {
  std::error_code ignored;
  if (fs::is_directory(folder, ignored) && !fs::is_symlink(folder, ignored) &&
      fs::exists(folder / run_folder::kManifest, ignored)) {
    fs::remove_all(folder, ignored);
  }
}

void PrintResult(const FalsifyResult& result, const CheckedSearch& search, const fs::path& out) {
  const std::string& name = search.study.name;
  if (result.status == FalsifyStatus::kInterrupted) {
    fmt::print("{}: interrupted after {} runs; the same command goes on\n", name, result.runs);
    return;
  }
  const std::string time = result.out_of_time ? " (the time was up)" : "";
  if (!result.counterexample) {
    fmt::print("{}: not falsified in {} runs{}", name, result.runs, time);
    if (result.least) {
      fmt::print("; the lowest robustness is {:.4g} ({}), row {}", result.least->robustness,
                 result.least->limit, result.least->row);
    }
    fmt::print("; in {}\n", (out / run_folder::kSweepCsv).string());
    return;
  }
  const SearchedPoint& worst = *result.counterexample;
  fmt::print("{}: broken: {} of {} runs failed{}, the first is row {}\n", name, result.violations,
             result.runs, time, result.first->row);
  fmt::print("  {}\n", worst.reason);
  fmt::print(
      "  robustness {:.4g} ({}), distance {:.4g} from the nominal point after {} runs to "
      "shrink it{}\n",
      worst.robustness, worst.limit, Distance(worst.point, search.space.nominal()),
      result.shrink_runs,
      result.shrunk.point.empty() || result.shrunk.complete ? "" : ", which were not enough");
  PrintMargins(result, search);
  fmt::print("  {}\n",
             (out / run_folder::kCounterexample / run_folder::kCounterexampleYaml).string());
}

int Falsify(const FalsifyVerbOptions& options) {
  const CheckedSearch search = CheckSearch(options.scenario.ReadStudyFile(options.file));
  const std::string& name = search.study.name;
  const fs::path out = options.out.empty() ? fs::path("out") / name : fs::path(options.out);
  const OutputFolder folder(out);  // before the work, not after it
  if (options.video) {
    CheckFilmName(out / run_folder::kCounterexample / run_folder::kVideo);
    CheckGl(options.gl);
  }
  const fs::path file = out / run_folder::kSweepRecords;
  if (options.restart) {
    std::error_code ignored;
    fs::remove(file, ignored);
  }
  SweepRecords records(file, FalsifyHeader(search));
  if (records.count() > 0 && !options.scenario.quiet) {
    fmt::print("{}: {} runs are there already\n", name, records.count());
  }
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  FalsifyResult result;
  {
    ProgressBar bar(name, options.scenario.quiet);
    const int most = search.study.search->runs + 1;
    result = trackbed::Falsify(
        search, records,
        {.jobs = options.jobs > 0 ? options.jobs : threads,
         .interrupted = [] { return interrupted.load(); },
         .progress =
             [&](std::size_t row) {
               bar.Show(std::min(1.0, static_cast<double>(row + 1) / static_cast<double>(most)));
             },
         .time_limit = options.time});
  }
  const SweepSummary table = WriteTable(records, folder);
  {
    ResultWriter writer(folder);
    writer.Add(run_folder::kFalsifyJson, ToJson(result, search).dump(2) + "\n");
    writer.Commit(kFalsification, {});
  }
  if (!options.scenario.quiet) {
    PrintResult(result, search, out);
  }
  PrintRowsWithoutRun(name, table);
  if (result.status == FalsifyStatus::kBroken) {
    WriteCounterexample(result, search, out / run_folder::kCounterexample, options);
  } else {
    RemoveCounterexample(out / run_folder::kCounterexample);
  }
  if (options.report && result.status != FalsifyStatus::kInterrupted) {
    WriteReport({out}, out / run_folder::kReport);
  }
  return result.status == FalsifyStatus::kInterrupted ? kInterrupted
         : result.status == FalsifyStatus::kBroken    ? kFailedExpectations
         : result.errors > 0                          ? kInternal
                                                      : kOk;
}

}  // namespace

void AddFalsify(const Command& command) {
  const auto options = std::make_shared<FalsifyVerbOptions>();
  command.AddPositional("study", options->file, "Study file with a search")
      .Required()
      .TypeName("STUDY");
  command
      .AddOption("-j,--jobs", options->jobs, "Runs in parallel (default: one per hardware thread)")
      .Range(1, 1000)
      .TypeName("N");
  command.AddOption("-o,--out", options->out, "Output folder (default: out/<study>)")
      .TypeName("DIR");
  command
      .AddOption("--time", options->time,
                 "End the search after this many wall-clock seconds; the result then depends on "
                 "the machine")
      .Range(0.0, 1e6)
      .TypeName("SECONDS");
  command.AddFlag("--restart", options->restart,
                  "Begin anew; else a search that was interrupted goes on where it was");
  command.AddFlag("--video", options->video, "Also render video.mp4 of the counterexample");
  AddGlOption(command, options->gl);
  command.AddFlag("--report", options->report,
                  "Also write report.html of the search and of the counterexample");
  options->scenario.AddTo(command);
  command.AddExample("A shipped study", "trackbed falsify lane_change_friction --jobs 2");
  command.OnRun([options] { return Falsify(*options); });
}

}  // namespace trackbed::cli
