#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run.h"
#include "trackbed/analysis/sweep_records.h"
#include "trackbed/core/text_table.h"
#include "trackbed/scenario/study.h"

/// Runs a study and makes one table of it.
namespace trackbed {

/// Results of a run as a table shows them, by their dotted paths: `metrics.<plant>.…`,
/// `between.<plant>.<plant>.…`, `verdict.passed`, `verdict.failures`, `verdict.robustness`
/// (RobustnessOf), `plan.status`, `plan.length_m` and the other PathProperties(),
/// `timing.planning_s` (another one every time); the names are those of metrics.json, elements of
/// lists are `[0]`, `[1]`, …. What a run on one plant has under that plant's name it has as
/// `metrics.*.…` too, so that a study of plants needs one column for each result.
using Outputs = std::map<std::string, std::string>;

Outputs CollectOutputs(const RunResult& result);

/// The paths of everything that runs of the scenario may have, sorted.
std::vector<std::string> PossibleOutputs(const Scenario& scenario);

/// The result of one run.
struct RunOutcome {
  std::string status;  ///< "passed", "failed", "driven" (nothing was expected), or "no_plan"
  bool passed = false;
  std::string reason{};  ///< of one that failed or has no plan
  Outputs outputs;
  std::optional<RunResult> result{};  ///< all of it, if DriveOnce has run it
};

/// Runs a scenario, on any thread; nothing when it was interrupted.
using RunScenarioOnce = std::function<std::optional<RunOutcome>(const Scenario& scenario)>;

/// A study that has been validated as far as possible before it is run. Immutable, and shared
/// between threads.
struct CheckedStudy {
  StudyPoints points;
  std::unique_ptr<CarCache> cars;             ///< never null
  std::map<std::string, std::string> inputs;  ///< SHA-256 of what the study is made of, by its name
};

/// Reads the points of the study (CheckPoints), compiles the cars, makes the plants and checks the
/// outputs. InputError with the problems of the points, of their cars, or of all outputs with the
/// nearest path: unless `all` points must be good, only if none is.
CheckedStudy CheckStudy(Study study, bool all = true);

/// Plans, drives, measures and judges a scenario of the study.
std::optional<RunOutcome> DriveOnce(const CheckedStudy& checked, const Scenario& scenario,
                                    const std::function<bool()>& interrupted = {});

/// A part of the rows of a study: of every `count` rows the one at `index`, from 1.
struct Shard {
  int index = 1;
  int count = 1;

  [[nodiscard]] bool Has(std::size_t row) const {
    return row % static_cast<std::size_t>(count) == static_cast<std::size_t>(index - 1);
  }
};

struct SweepOptions {
  int jobs = 1;                                   ///< runs at the same time, at least 1
  std::function<void(double fraction)> progress;  ///< called after each row, by one thread at once
  std::function<bool()> interrupted;              ///< asked before each run, by any thread
  Shard shard{};                                  ///< of the rows, the others are left out
  /// If there are any: instead of the rows that are missing, those with one of these statuses.
  std::vector<std::string> again{};
  /// Called after each run, by any thread, before its row is appended; not of bisections.
  std::function<void(std::size_t row, const RunOutcome& outcome)> finished{};
  /// Stop as soon as the interval of the pass rate at each point of the grid is this narrow: half
  /// of its width, from 0.001 to 0.5. For studies with a sample, without bisection. Looked at after
  /// every kUntilSamples points of the sample, so that it does not depend on `jobs`.
  std::optional<double> until_pass_rate{};
};

inline constexpr std::size_t kUntilSamples = 100;

/// The rows that a study has: each point `repeat` times.
std::size_t CountRows(const StudyPoints& points);

/// What tells the records of the study from those of others: its description, its columns, the
/// versions of the programs, and `inputs`, the hashes of what it is made of.
nlohmann::ordered_json SweepHeader(const StudyPoints& points,
                                   const std::map<std::string, std::string>& inputs = {});

/// Runs the rows of a study that `records` has not, each point `repeat` times with its seed counted
/// up, or bisects at each, and appends every row as soon as it is finished. An interruption leaves
/// unfinished rows out.
///
/// A point that is refused, and a run that throws an InputError, have a row with the status
/// `refused` and the first problem as the reason; a run that throws what tells of a bug, one with
/// the status `error`. The other runs are not affected.
///
/// Guarantees: what a row has does not depend on `jobs`, shards, or the order in which rows are
/// finished. A RunError of `run` (no memory) or of `records` (a full disk) stops the sweep and is
/// thrown on. InternalError unless jobs is positive. Memory does not grow with the rows, beside
/// that of SweepRecords.
void RunRows(const StudyPoints& points, const RunScenarioOnce& run, SweepRecords& records,
             const SweepOptions& options);

/// What there is in some records.
struct SweepSummary {
  std::size_t rows = 0;
  std::size_t rows_expected = 0;  ///< more than there are when it was interrupted
  std::size_t runs = 0;           ///< of these rows
  std::size_t passed = 0;         ///< rows that passed, or whose bisection found a value
  std::size_t refused = 0;        ///< rows whose scenario is wrong
  std::size_t errors = 0;         ///< rows whose run met a bug of the program

  [[nodiscard]] bool complete() const { return rows == rows_expected; }
};

/// Counts what there is of the shard.
SweepSummary Summarize(const SweepRecords& records, const Shard& shard = {});

/// Writes sweep.csv (parameters, seed, status, runs, outputs, reason; rows in the grid's order),
/// sweep.json (the study as it was run, and bisections) and manifest.json, all at once
/// (ResultWriter), and removes the report.html of an earlier sweep. `stopped` says why rows are
/// missing on purpose. RunError: the earlier sweep is still there then.
SweepSummary WriteSweep(const SweepRecords& records, const Shard& shard, const OutputFolder& folder,
                        const std::string& stopped = "");

/// Puts the rows of several records of one study, such as those of its shards, into others of it.
///
/// InputError naming a file and what is different when its study is another one, and when a row
/// differs between two.
void MergeRecords(const std::vector<std::filesystem::path>& files, SweepRecords& records);

/// The row numbers whose run folders a study keeps that asks for the highest or lowest values of an
/// output: the worst first, of equal ones the first rows.
std::vector<std::size_t> WorstRows(const SweepRecords& records);

/// What a row sets, in the order in which it does, for the scenario that the header names: with
/// these overrides a run is that of the row. InputError when there is no such row.
std::vector<Override> OverridesOfRow(const SweepRecords& records, std::size_t row);

/// "3, 17 to 20": the rows, from 0, that are missing.
std::string MissingRows(const SweepRecords& records);

/// A study of few rows, in memory.
struct SweepResult {
  TextTable table{{"status"}};         ///< as sweep.csv
  nlohmann::ordered_json description;  ///< as sweep.json
  SweepSummary summary;
};

/// RunRows for all rows, in memory.
SweepResult RunSweep(const StudyPoints& points, const RunScenarioOnce& run,
                     const SweepOptions& options);

}  // namespace trackbed
