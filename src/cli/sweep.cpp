#include "trackbed/analysis/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "src/cli/output_file.h"
#include "src/cli/progress_bar.h"
#include "src/cli/scenario_options.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/sweep_folders.h"
#include "src/cli/sweep_table.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/bisect.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"

// The verb `sweep` reads the study and its options. The verb `sweep` runs rows (runs of the study)
// in parallel and writes their table. The command line selects the rows of the shard, the rows
// given by --only, or the missing rows of an interrupted study. With --until, the study ends as
// soon as the confidence intervals of its pass rates are narrow enough.

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct SweepVerbOptions {
  std::string file;
  std::string out;
  std::string shard;
  std::vector<std::string> only;
  std::string until;
  bool restart = false;
  int jobs = 0;  // number of parallel threads; 0: one per hardware thread
  ScenarioOptions scenario;
};

[[noreturn]] void Refuse(const char* option, std::string message) {
  throw InputError(Problem{.key = option, .message = std::move(message)});
}

/// Parses the number of a shard, such as "2/7" for the second of seven parts of a study.
Shard ParseShard(const std::string& text) {
  Shard shard;
  const std::size_t slash = text.find('/');
  const auto number = [&](std::string_view part, int& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc{} && end == part.data() + part.size();
  };
  const std::string_view view = text;
  if (slash == std::string::npos || !number(view.substr(0, slash), shard.index) ||
      !number(view.substr(slash + 1), shard.count) || shard.index < 1 ||
      shard.index > shard.count) {
    Refuse("--shard",
           fmt::format("'{}' is no shard; give I/N, such as 2/7 for the second of seven", text));
  }
  return shard;
}

/// Parses the value of --until, such as "pass_rate:0.01", and returns the half width of the
/// confidence interval.
std::optional<double> ParseUntil(const std::string& text, const Study& study) {
  if (text.empty()) {
    return std::nullopt;
  }
  constexpr std::string_view kName = "pass_rate:";
  // The plus-minus sign in UTF-8, which users may write before the number.
  constexpr std::string_view kPlusMinus = "\u00b1";
  std::string_view number = text;
  double width = 0.0;
  if (number.starts_with(kName)) {
    number.remove_prefix(kName.size());
    number.remove_prefix(number.starts_with(kPlusMinus) ? kPlusMinus.size() : 0);
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), width);
    width = error == std::errc{} && end == number.data() + number.size() ? width : 0.0;
  }
  if (!(width >= 0.001 && width <= 0.5)) {
    Refuse("--until",
           fmt::format("'{}' is not understood; give pass_rate:W, such as pass_rate:0.01 "
                       "for an interval of +-0.01; W from 0.001 to 0.5",
                       text));
  }
  if (!study.sample || study.bisect) {
    Refuse("--until", "needs a study with a sample and without bisect");
  }
  return width;
}

/// Returns the shard of the Slurm array task in which the program runs. Outside Slurm, returns the
/// shard that contains all rows of the study.
Shard ShardOfTask() {
  const auto number = [](const char* name) {
    const char* text = std::getenv(name);
    return text == nullptr ? std::nullopt : std::optional(std::atoi(text));
  };
  const std::optional<int> id = number("SLURM_ARRAY_TASK_ID");
  const std::optional<int> count = number("SLURM_ARRAY_TASK_COUNT");
  const int first = number("SLURM_ARRAY_TASK_MIN").value_or(0);
  const int step = std::max(1, number("SLURM_ARRAY_TASK_STEP").value_or(1));
  if (!id || !count) {
    return {};
  }
  const Shard shard{.index = (*id - first) / step + 1, .count = *count};
  if (*id < first || (*id - first) % step != 0 || shard.index > shard.count) {
    Refuse("SLURM_ARRAY_TASK_ID",
           fmt::format("{} is no task of an array of {} from {} in steps of {}", *id, *count, first,
                       step));
  }
  return shard;
}

/// Checks the option --only, which repeats rows of a study: its run statuses must exist, and the
/// record file must contain rows.
void CheckOnly(const SweepVerbOptions& options, const Study& study, const fs::path& records) {
  const std::vector<std::string> statuses =
      study.bisect
          ? std::vector<std::string>{ToString(BisectStatus::kFound),
                                     ToString(BisectStatus::kPassesAtTo),
                                     ToString(BisectStatus::kFailsAtFrom), "refused", "error"}
          : std::vector<std::string>{"passed", "failed", "driven", "no_plan", "refused", "error"};
  for (const std::string& status : options.only) {
    if (std::find(statuses.begin(), statuses.end(), status) == statuses.end()) {
      Refuse("--only", "unknown status " + UnknownName(status, statuses));
    }
  }
  if (!options.only.empty() && !fs::exists(records)) {
    Refuse("--only", fmt::format("there are no rows yet in {}; leave out --only to run the study",
                                 records.string()));
  }
}

/// Describes how the study ended, with its number of rows.
std::string HowItEnded(const SweepSummary& sweep, bool has_only, bool stopped,
                       const std::optional<double>& until) {
  if (sweep.complete()) {
    return fmt::format("{} rows from {} runs, {} passed", sweep.rows, sweep.runs, sweep.passed);
  }
  if (stopped) {
    return fmt::format(
        "stopped after {} of {} rows, {} passed: all pass rates are known to +-{} (95 %)",
        sweep.rows, sweep.rows_expected, sweep.passed, *until);
  }
  if (has_only && !interrupted) {
    return fmt::format("{} of {} rows, {} passed; without --only, the study goes on", sweep.rows,
                       sweep.rows_expected, sweep.passed);
  }
  return fmt::format("interrupted after {} of {} rows; the same command goes on", sweep.rows,
                     sweep.rows_expected);
}

int Sweep(const SweepVerbOptions& options) {
  const Shard shard = options.shard.empty() ? ShardOfTask() : ParseShard(options.shard);
  const CheckedStudy checked =
      CheckStudy(options.scenario.ReadStudyFile(options.file), /*all=*/false);
  const Study& study = checked.points.study();
  const std::optional<double> until = ParseUntil(options.until, study);
  if (until && (shard.count > 1 || !options.only.empty())) {
    Refuse("--until", "needs all rows; leave out --shard and --only");
  }
  const std::string& name = study.name;
  const fs::path all = OutputFolderOf(options.out, name);
  const fs::path out = FolderOfShard(all, shard);
  const fs::path file = out / run_folder::kSweepRecords;
  CheckOnly(options, study, file);
  // Lock the output folder before the runs, so that a locking error appears before the long
  // computation.
  const OutputFolder folder(out, FileNamesOfVerb("sweep"));
  CheckKeptRows(all);
  if (options.restart) {
    SweepRecords::Remove(file);
    RemoveKeptRows(all);
  }
  SweepRecords records(file, SweepHeader(checked.points, checked.inputs));
  const std::size_t before = records.count();
  if (before > 0 && !options.scenario.quiet) {
    Print("{}: {} of {} rows are there already\n", name, before, records.rows());
  }
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const auto is_interrupted = [] { return interrupted.load(); };
  const auto keep = [&](std::size_t row, const RunOutcome& outcome) {
    const KeepSpec::Rows rows = study.keep.rows;
    if (rows == KeepSpec::Rows::kAll || (rows == KeepSpec::Rows::kFailed && !outcome.passed)) {
      WriteRunFolder(*outcome.result, FolderOfRow(all, row));
    }
  };
  {
    ProgressBar bar(name, options.scenario.quiet);
    RunRows(checked.points,
            [&](const Scenario& scenario) { return DriveOnce(checked, scenario, is_interrupted); },
            records,
            {.jobs = options.jobs > 0 ? options.jobs : threads,
             .progress = [&](double fraction) { bar.Show(fraction); },
             .interrupted = is_interrupted,
             .shard = shard,
             .again = options.only,
             .finished = keep,
             .until_pass_rate = until});
  }
  const bool stopped = until && !interrupted && records.count() < records.rows();
  const SweepSummary sweep = WriteSweep(records, shard, folder, stopped ? options.until : "");
  if (!options.scenario.quiet) {
    const std::string how = HowItEnded(sweep, !options.only.empty(), stopped, until);
    const fs::path csv = out / run_folder::kSweepCsv;
    Print("{}: {}, in {}\n", name, how, csv.string());
    // Largest number of rows of sweep.csv for which a table is printed; reading more rows would
    // take more memory than the study itself.
    constexpr std::size_t kMaxRows = 100'000;
    if (sweep.rows <= kMaxRows) {
      Print("{}", Lines{SweepTableText(ReadTextCsv(csv), TerminalWidth())});
    }
  }
  if (shard.count == 1 && (sweep.complete() || stopped)) {
    KeepWorstRows(records, all, options.scenario);
  }
  PrintRowsWithoutRun(name, sweep);
  const bool ended = sweep.complete() || stopped || (!options.only.empty() && !interrupted);
  return sweep.errors > 0 ? kInternal : ended ? kOk : kInterrupted;
}

}  // namespace

void AddSweep(const Command& command) {
  const auto options = std::make_shared<SweepVerbOptions>();
  command.AddPositional("study", options->file, "Study file").Required().TypeName("STUDY");
  AddJobs(command, options->jobs, "Runs in parallel");
  command.AddOption("-o,--out", options->out, "Output folder (default: out/<study>)")
      .TypeName("DIR");
  command
      .AddOption(
          "--shard", options->shard,
          "Run one of N parts of the rows, for several machines: every N-th row from the I-th")
      .TypeName("I/N");
  command
      .AddOption("--only", options->only,
                 "Run the rows with these statuses once more, such as failed or error")
      .TypeName("STATUS")
      .Delimiter(',')
      .OneWord();
  command
      .AddOption(
          "--until", options->until,
          "Stop when half the 95 % interval of the pass rate at each point of the grid is at "
          "most W, such as pass_rate:0.01")
      .TypeName("pass_rate:W");
  command.AddFlag("--restart", options->restart,
                  "Begin anew; else a study that was interrupted goes on where it was");
  options->scenario.AddTo(command);
  command.AddExample("A shipped study", "trackbed sweep steering_delay --jobs 2");
  command.OnRun([options] { return Sweep(*options); });
  AddSweepMerge(command.AddVerb("merge", "Put the rows of a study's shards into one table"));
  AddSweepSubmit(
      command.AddVerb("submit", "Hand a study to Slurm, as an array of tasks and a merge"));
}

}  // namespace trackbed::cli
