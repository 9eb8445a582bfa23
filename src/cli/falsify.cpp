#include "trackbed/falsify/falsify.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "src/cli/film_of_run.h"
#include "src/cli/output_file.h"
#include "src/cli/progress_bar.h"
#include "src/cli/scenario_options.h"
#include "src/cli/sweep_folders.h"
#include "src/cli/terminal.h"
#include "src/cli/text_columns.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/falsify/counterexample.h"
#include "trackbed/report/report.h"

// `trackbed falsify` searches the parameter space of a study for a failing run
// (src/falsify/falsify.cpp). If an earlier search was interrupted, `falsify` continues the search
// from the recorded runs. The verb `falsify` writes the table of runs and falsify.json. If a run
// fails, `falsify` also writes the run folder of the shrunk counterexample, with a scenario for a
// test suite. On request, `falsify` also writes a video and a report of the counterexample.
namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct FalsifyVerbOptions {
  std::string file;
  std::string out;
  std::optional<double> time;
  bool restart = false;
  bool video = false;
  std::string gl = FilmOptions{}.gl;
  bool report = false;
  int jobs = 0;  // number of parallel threads; 0: one per hardware thread
  ScenarioOptions scenario;
};

/// Writes the outcome of the search to falsify.json, and the table of the runs. The outcome in
/// falsify.json contains a hash of the counterexample's run, so that the run folder of another
/// search is not mistaken for the counterexample.
SweepSummary WriteOutcome(const SweepRecords& records, nlohmann::ordered_json outcome,
                          const OutputFolder& folder) {
  nlohmann::ordered_json header = records.header();
  // Without any run, rows_expected remains the planned number of rows, because a table that expects
  // 0 rows is invalid.
  if (records.count() > 0) {
    header["rows_expected"] = records.count();
  }
  SweepRecords whole = SweepRecords::InMemory(header);
  for (std::size_t row = 0; row < records.count(); ++row) {
    whole.Append(row, records.Read(row));
  }
  outcome["result"] = outcome.contains(run_folder::kCounterexample)
                          ? run_folder::ResultHash(folder.path() / run_folder::kCounterexample)
                          : "";
  ResultWriter writer(folder);
  const SweepSummary table = AddSweep(whole, {}, writer);
  writer.Add(run_folder::kFalsifyJson, JsonText(outcome));
  writer.Commit(run_folder::kFalsification, {});
  return table;
}

/// Writes the run folder of the counterexample, with a scenario file that reproduces the failure in
/// a test suite.
void WriteCounterexample(const RunResult& run, const CheckedSearch& search, const fs::path& out) {
  const Regression regression =
      MakeRegression(run, search.study.name + "_" + run_folder::kCounterexample);
  const OutputFolder folder(out);
  ResultWriter writer(folder);
  AddRunFolder(run, writer);
  writer.Add(run_folder::kCounterexampleYaml, RegressionYaml(regression, run));
  writer.Commit(run_folder::kCounterexample, {});
}

/// Adds the film and the report to the run folder of the counterexample, if requested.
void ShowCounterexample(const RunResult& run, const FalsifyResult& result,
                        const CheckedSearch& search, const fs::path& out,
                        const FalsifyVerbOptions& options) {
  if (options.video && run.plan.ok()) {
    FilmOptions film = FilmOptionsOf(run.scenario.render, options.gl);
    film.title = search.study.name + ": " + run_folder::kCounterexample;
    film.note = result.counterexample->reason;
    FilmRun(out, out / run_folder::kVideo, film, options.scenario.quiet);
  }
  if (options.report) {
    WriteReport({out}, out / run_folder::kReport);
  }
}

/// Formats a number such as "18.2"; returns a dash if the number is unknown.
std::string Cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.5g}", *value) : "-";
}

/// Formats the range of a key's values for which the run passes, such as "16.4 to 18.2".
std::string ReachText(const SearchSpace& space, std::size_t i, const KeyMargin& margin) {
  const auto end = [&](const std::optional<SingleKeyReach>& alone) {
    return alone ? space.Value(i, alone->passes) : space.keys()[i].nominal;
  };
  if (!margin.down && !margin.up) {
    return "-";
  }
  return fmt::format("{:.5g} to {:.5g}", end(margin.down), end(margin.up));
}

void PrintMargins(const FalsifyResult& result, const CheckedSearch& search) {
  const ShrinkResult& shrunk = result.shrunk;
  if (shrunk.keys.empty()) {
    return;  // print nothing, because the counterexample was not shrunk
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
    Print("{}\n", line);
  }
}

void PrintResult(const FalsifyResult& result, const CheckedSearch& search, const fs::path& out) {
  const std::string& name = search.study.name;
  if (result.status == FalsifyStatus::kInterrupted) {
    Print("{}: interrupted after {} runs; the same command goes on\n", name, result.runs);
    return;
  }
  const std::string time = result.out_of_time ? " (the time was up)" : "";
  if (!result.counterexample) {
    Print("{}: not falsified in {} runs{}", name, result.runs, time);
    if (result.least) {
      Print("; the lowest robustness is {:.4g} ({}), row {}", result.least->robustness,
            result.least->limit, result.least->row);
    }
    Print("; in {}\n", (out / run_folder::kSweepCsv).string());
    return;
  }
  const SearchedPoint& worst = *result.counterexample;
  Print("{}: broken: {} of {} runs failed{}, the first is row {}\n", name, result.violations,
        result.runs, time, result.first->row);
  Print("  {}\n", worst.reason);
  Print(
      "  robustness {:.4g} ({}), distance {:.4g} from the nominal point after {} runs to "
      "shrink it{}\n",
      worst.robustness, worst.limit, Distance(worst.point, search.space.nominal()),
      result.shrink_runs,
      result.shrunk.point.empty() || result.shrunk.complete ? "" : ", which were not enough");
  PrintMargins(result, search);
  Print("  {}\n", (out / run_folder::kCounterexample / run_folder::kCounterexampleYaml).string());
}

int Falsify(const FalsifyVerbOptions& options) {
  const CheckedSearch search = CheckSearch(options.scenario.ReadStudyFile(options.file));
  const std::string& name = search.study.name;
  const fs::path out = OutputFolderOf(options.out, name);
  // Lock the output folder before the search, so that a locking error appears before the long
  // search.
  const OutputFolder folder(out, FileNamesOfVerb("falsify"));
  const fs::path counterexample = FolderBelow(out, run_folder::kCounterexample);
  std::vector<std::string> names = run_folder::AllNames();
  names.emplace_back(run_folder::kCounterexampleYaml);
  RequireNoForeignFiles(counterexample, names);
  if (options.video) {
    CheckFilmName(counterexample / run_folder::kVideo);
    CheckGl(options.gl);
  }
  const fs::path file = out / run_folder::kSweepRecords;
  if (options.restart) {
    SweepRecords::Remove(file);
  }
  SweepRecords records(file, FalsifyHeader(search));
  if (records.count() > 0 && !options.scenario.quiet) {
    Print("{}: {} runs are there already\n", name, records.count());
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
  std::optional<RunResult> failed;
  if (result.status == FalsifyStatus::kBroken) {
    failed = RunCounterexample(result, search);
    WriteCounterexample(*failed, search, counterexample);
  }
  const SweepSummary table = WriteOutcome(records, ToJson(result, search), folder);
  if (!failed) {
    RemoveResults(counterexample);
  }
  if (!options.scenario.quiet) {
    PrintResult(result, search, out);
  }
  PrintRowsWithoutRun(name, table);
  if (failed) {
    ShowCounterexample(*failed, result, search, counterexample, options);
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
  AddJobs(command, options->jobs, "Runs in parallel");
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
