#include "trackbed/analysis/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "src/cli/progress_bar.h"
#include "src/cli/scenario_options.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShardFolder = "shard_";

struct SweepVerbOptions {
  std::string file;
  std::string out;
  std::string shard;
  std::vector<std::string> only;
  std::string until;
  bool restart = false;
  int jobs = 0;  // 0: as many as the machine runs threads
  ScenarioOptions scenario;
};

[[noreturn]] void Refuse(const char* option, std::string message) {
  throw InputError(Problem{.key = option, .message = std::move(message)});
}

/// "2/7".
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

/// Half the width of the interval in "pass_rate:0.01".
std::optional<double> ParseUntil(const std::string& text, const Study& study) {
  if (text.empty()) {
    return std::nullopt;
  }
  constexpr std::string_view kName = "pass_rate:";
  constexpr std::string_view kPlusMinus = "\u00b1";  // as it is often written
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

/// That of the task of a Slurm array in which the program runs, or all.
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

/// Where a shard has its files, below the folder of the study.
fs::path FolderOfShard(const fs::path& study, const Shard& shard) {
  return shard.count == 1
             ? study
             : study / fmt::format("{}{}_of_{}", kShardFolder, shard.index, shard.count);
}

fs::path FolderOfRow(const fs::path& study, std::size_t row) {
  return study / "rows" / std::to_string(row);
}

/// Removes the run folders of rows.
void RemoveKeptRows(const fs::path& study) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (fs::directory_iterator at(study / "rows", error), end; !error && at != end;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (at->is_directory(error) && !at->is_symlink(error) &&
        name.find_first_not_of("0123456789") == std::string::npos &&
        fs::exists(at->path() / run_folder::kManifest, error)) {
      folders.push_back(at->path());
    }
  }
  for (const fs::path& folder : folders) {
    fs::remove_all(folder, error);
  }
}

/// Runs once more the rows with the worst values that the study keeps, those that are not there
/// yet.
void KeepWorstRows(const SweepRecords& records, const fs::path& out,
                   const ScenarioOptions& options) {
  const nlohmann::ordered_json& header = records.header();
  if (!header.contains("keep") || !header["keep"].is_object()) {
    return;
  }
  for (const std::size_t row : WorstRows(records)) {
    const fs::path folder = FolderOfRow(out, row);
    std::error_code ignored;
    if (fs::exists(folder / run_folder::kMetricsJson, ignored)) {
      continue;
    }
    ScenarioOptions own = options;
    own.overrides = OverridesOfRow(records, row);
    const auto [locked, result] =
        DriveScenario({own.Read(header.at("scenario").get<std::string>()), folder}, options.quiet);
    if (result.interrupted) {
      return;
    }
    WriteRunFolder(result, locked);
  }
}

void PrintRowsWithoutRun(const std::string& name, const SweepSummary& sweep) {
  if (sweep.refused + sweep.errors > 0) {
    std::fflush(stdout);  // behind what is said of all rows
    fmt::print(stderr,
               "{}: {} rows without a run: {} refused, {} with an internal error; see the "
               "column reason\n",
               name, sweep.refused + sweep.errors, sweep.refused, sweep.errors);
  }
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
  const fs::path all = options.out.empty() ? fs::path("out") / name : fs::path(options.out);
  const fs::path out = FolderOfShard(all, shard);
  const OutputFolder folder(out);  // before the work, not after it

  const fs::path file = out / run_folder::kSweepRecords;
  if (options.restart) {
    std::error_code ignored;
    fs::remove(file, ignored);
    RemoveKeptRows(all);
  }
  SweepRecords records(file, SweepHeader(checked.points, checked.inputs));
  const std::size_t before = records.count();
  if (before > 0 && !options.scenario.quiet) {
    fmt::print("{}: {} of {} rows are there already\n", name, before, records.rows());
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
    const std::string how =
        sweep.complete()
            ? fmt::format("{} rows from {} runs, {} passed", sweep.rows, sweep.runs, sweep.passed)
        : stopped ? fmt::format(
                        "stopped after {} of {} rows, {} passed: all pass rates are known to "
                        "+-{} (95 %)",
                        sweep.rows, sweep.rows_expected, sweep.passed, *until)
                  : fmt::format("interrupted after {} of {} rows; the same command goes on",
                                sweep.rows, sweep.rows_expected);
    fmt::print("{}: {}, in {}\n", name, how, (out / run_folder::kSweepCsv).string());
  }
  if (shard.count == 1 && (sweep.complete() || stopped)) {
    KeepWorstRows(records, all, options.scenario);
  }
  PrintRowsWithoutRun(name, sweep);
  return sweep.errors > 0 ? kInternal : sweep.complete() || stopped ? kOk : kInterrupted;
}

struct MergeOptions {
  std::vector<std::string> folders;
  std::string out;
  bool partial = false;
  bool quiet = false;
};

/// The records of a folder, or of the shards in it.
std::vector<fs::path> RecordsIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path file = at->path() / run_folder::kSweepRecords;
    if (at->path().filename().string().starts_with(kShardFolder) && fs::exists(file, error)) {
      files.push_back(file);
    }
  }
  if (files.empty()) {
    files.push_back(folder / run_folder::kSweepRecords);
    if (!fs::exists(files.back(), error)) {
      throw InputError(Problem{.file = folder.string(),
                               .message = fmt::format("has neither {} nor folders of shards",
                                                      run_folder::kSweepRecords)});
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

int Merge(const MergeOptions& options) {
  std::vector<fs::path> files;
  for (const std::string& folder : options.folders) {
    const std::vector<fs::path> own = RecordsIn(folder);
    files.insert(files.end(), own.begin(), own.end());
  }
  const nlohmann::ordered_json header = SweepRecords(files.front()).header();
  const fs::path out =
      options.out.empty() ? fs::path(options.folders.front()) : fs::path(options.out);
  const OutputFolder folder(out);
  SweepRecords records(out / run_folder::kSweepRecords, header);
  MergeRecords(files, records);
  const std::string name = header.value("study", "");
  if (records.count() < records.rows() && !options.partial) {
    throw InputError(Problem{
        .file = out.string(),
        .message =
            fmt::format("{} of {} rows are missing: {}; --partial merges what there is",
                        records.rows() - records.count(), records.rows(), MissingRows(records))});
  }
  const SweepSummary sweep = WriteSweep(records, {}, folder);
  if (!options.quiet) {
    fmt::print("{}: {} of {} rows from {} files, {} passed, in {}\n", name, sweep.rows,
               sweep.rows_expected, files.size(), sweep.passed,
               (out / run_folder::kSweepCsv).string());
  }
  if (sweep.complete()) {
    ScenarioOptions scenario;
    scenario.quiet = options.quiet;
    KeepWorstRows(records, out, scenario);
  }
  PrintRowsWithoutRun(name, sweep);
  return kOk;
}

void AddMerge(const Command& command) {
  const auto options = std::make_shared<MergeOptions>();
  command
      .AddPositional("folders", options->folders,
                     "Output folders of shards, or folders that have them")
      .Required()
      .TypeName("DIR...");
  command.AddOption("-o,--out", options->out, "Output folder (default: the first of these)")
      .TypeName("DIR");
  command.AddFlag("--partial", options->partial, "Merge although rows are missing");
  command.AddFlag("-q,--quiet", options->quiet, "Print only problems");
  command.OnRun([options] { return Merge(*options); });
}

struct SubmitOptions {
  std::string file;
  std::string out;
  int tasks = 1;
  std::vector<std::string> sbatch;
  ScenarioOptions scenario;
};

/// A word as the shell takes it for that word.
std::string Quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) {
    quoted += c == '\'' ? "'\\''" : std::string(1, c);
  }
  return quoted + "'";
}

/// Hands a script to Slurm; its job's number.
std::string Submit(const std::string& options, const fs::path& script) {
  const std::string command =
      fmt::format("sbatch --parsable {} {} 2>&1", options, Quoted(script.string()));
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  if (!pipe) {
    throw RunError("cannot run sbatch");
  }
  std::string said;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe.get()) != nullptr) {
    said += part.data();
  }
  said.erase(said.find_last_not_of("\n") + 1);
  // "123", or "123;cluster".
  const std::string job = said.substr(0, said.find(';'));
  if (job.empty() || job.find_first_not_of("0123456789") != std::string::npos) {
    throw RunError(fmt::format("sbatch did not take {}: {}", script.string(), said));
  }
  return job;
}

int SubmitStudy(const SubmitOptions& options) {
  const Study study = options.scenario.ReadStudyFile(options.file);
  const CheckedStudy checked = CheckStudy(study, /*all=*/false);
  const fs::path out =
      fs::absolute(options.out.empty() ? fs::path("out") / study.name : fs::path(options.out));
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  std::string sweep = fmt::format(
      "{} sweep {} --out {} --quiet --jobs \"${{SLURM_CPUS_PER_TASK:-1}}\"", Quoted(program),
      Quoted(fs::absolute(options.file).string()), Quoted(out.string()));
  for (const Override& text : study.overrides) {
    sweep += " --set " + Quoted(text);
  }
  for (const fs::path& folder : study.asset_folders) {
    sweep += " --allow-assets " + Quoted(fs::absolute(folder).string());
  }
  std::string sbatch;
  for (const std::string& option : options.sbatch) {
    sbatch += Quoted(option) + " ";
  }
  MakeFolder(out);
  const auto write = [&](const char* name, const std::string& lines) {
    WriteFileAtomically(out / name, "#!/bin/sh\n" + lines);
    return out / name;
  };
  const fs::path array = write(
      "array.sh", fmt::format("#SBATCH --job-name={}\n#SBATCH --array=1-{}\n#SBATCH --requeue\n"
                              "#SBATCH --output=task_%a.log\n#SBATCH --chdir={}\nexec {}\n",
                              study.name, options.tasks, out.string(), sweep));
  const fs::path merge = write(
      "merge.sh", fmt::format("#SBATCH --job-name={}_merge\n#SBATCH --output=merge.log\n"
                              "#SBATCH --chdir={}\nexec {} sweep merge {} --quiet\n",
                              study.name, out.string(), Quoted(program), Quoted(out.string())));
  const std::string job = Submit(sbatch, array);
  // The merging waits until all tasks have ended well, and goes when one has not.
  const std::string last = Submit(
      fmt::format("{}--dependency=afterok:{} --kill-on-invalid-dep=yes", sbatch, job), merge);
  if (!options.scenario.quiet) {
    fmt::print("{}: {} rows in {} tasks of job {}, then job {} merges them, in {}\n", study.name,
               CountRows(checked.points), options.tasks, job, last, out.string());
  }
  return kOk;
}

void AddSubmit(const Command& command) {
  const auto options = std::make_shared<SubmitOptions>();
  command.AddPositional("study", options->file, "Study file").Required().TypeName("STUDY");
  command.AddOption("--tasks", options->tasks, "Tasks of the array, each of which runs a shard")
      .Required()
      .Range(1, 100000)
      .TypeName("N");
  command
      .AddOption("-o,--out", options->out,
                 "Output folder, which all nodes have (default: out/<study>)")
      .TypeName("DIR");
  command
      .AddOption("--sbatch", options->sbatch,
                 "An option for sbatch, such as --sbatch=--time=2:00:00; may be repeated")
      .OneWord()
      .TypeName("OPTION");
  options->scenario.AddTo(command);
  command.OnRun([options] { return SubmitStudy(*options); });
}

}  // namespace

void AddSweep(const Command& command) {
  const auto options = std::make_shared<SweepVerbOptions>();
  command.AddPositional("study", options->file, "Study file").Required().TypeName("STUDY");
  command
      .AddOption("-j,--jobs", options->jobs, "Runs in parallel (default: one per hardware thread)")
      .Range(1, 1000)
      .TypeName("N");
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
  command.OnRun([options] { return Sweep(*options); });
  AddMerge(command.AddVerb("merge", "Put the rows of a study's shards into one table"));
  AddSubmit(command.AddVerb("submit", "Hand a study to Slurm, as an array of tasks and a merge"));
}

}  // namespace trackbed::cli
