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

/// Runs a study and writes its results to one table.
namespace trackbed {

/// Results of a run for a table, by their dotted paths: `metrics.<plant>.…`,
/// `between.<plant>.<plant>.…`, `verdict.passed`, `verdict.failures`, `verdict.robustness`
/// (RobustnessOf), `plan.status`, `plan.length_m` and the other PathProperties(),
/// `timing.planning_s` (differs every time). Names are those of metrics.json, elements of lists are
/// `[0]`, `[1]`, …. Results of a run on a single plant are also listed as `metrics.*.…`, so that a
/// study of plants needs one column for each result.
using Outputs = std::map<std::string, std::string>;

Outputs CollectOutputs(const RunResult& result);

/// The paths of all outputs that runs of the scenario may have, sorted.
std::vector<std::string> PossibleOutputs(const Scenario& scenario);

/// The result of one run.
struct RunOutcome {
  std::string status;  ///< "passed", "failed", "driven" (no expectations), or "no_plan"
  bool passed = false;
  std::string reason{};  ///< why it failed or has no plan
  Outputs outputs;
  std::optional<RunResult> result{};  ///< the complete result, if DriveOnce ran it
};

/// Runs a scenario, on any thread; returns nothing when interrupted.
using RunScenarioOnce = std::function<std::optional<RunOutcome>(const Scenario& scenario)>;

/// A study that has been validated as far as possible before it is run. Immutable, and shared
/// between threads.
struct CheckedStudy {
  StudyPoints points;
  std::unique_ptr<CarCache> cars;             ///< never null
  std::map<std::string, std::string> inputs;  ///< SHA-256 of the study's inputs, by name
};

/// Reads the points of the study (CheckPoints), compiles the cars, makes the plants and checks the
/// outputs. InputError with the problems of the points or their cars, or with all unknown outputs
/// and the nearest path to each. With `all`, one invalid point is an error; without, only if no
/// point is valid.
CheckedStudy CheckStudy(Study study, bool all = true);

/// Plans, simulates, measures and judges a scenario of the study.
std::optional<RunOutcome> DriveOnce(const CheckedStudy& checked, const Scenario& scenario,
                                    const std::function<bool()>& interrupted = {});

/// A part of the rows of a study: one of every `count` rows, the one at `index`, from 1.
struct Shard {
  int index = 1;
  int count = 1;

  [[nodiscard]] bool Has(std::size_t row) const {
    return row % static_cast<std::size_t>(count) == static_cast<std::size_t>(index - 1);
  }
};

struct SweepOptions {
  int jobs = 1;                                   ///< runs at the same time, at least 1
  std::function<void(double fraction)> progress;  ///< called after each row, one call at a time
  std::function<bool()> interrupted;              ///< asked before each run, by any thread
  Shard shard{};                                  ///< rows outside of the shard are left out
  /// If not empty: runs the rows with one of these statuses again, instead of the missing rows.
  std::vector<std::string> again{};
  /// Called after each run, by any thread, before its row is appended; not for bisections.
  std::function<void(std::size_t row, const RunOutcome& outcome)> finished{};
  /// Stops as soon as half the width of the pass rate's interval, at each point of the grid, is at
  /// most this: from 0.001 to 0.5. For studies with a sample, without bisection. Checked after
  /// every kUntilBatch points of the sample, so that the result does not depend on `jobs`.
  std::optional<double> until_pass_rate{};
};

inline constexpr std::size_t kUntilBatch = 100;

/// The number of rows of a study: each point `repeat` times.
std::size_t CountRows(const StudyPoints& points);

/// Identifies the records of the study: its description, its columns, the versions of the programs,
/// and `inputs`, the hashes of its input files.
nlohmann::ordered_json SweepHeader(const StudyPoints& points,
                                   const std::map<std::string, std::string>& inputs = {});

/// Runs the rows of a study that are missing in `records` and appends each as soon as it is
/// finished: each point `repeat` times with consecutive seeds, or a bisection at each. An
/// interruption leaves unfinished rows out.
///
/// A rejected point, and a run that throws an InputError, give a row with the status `refused` and
/// the first problem as the reason. A run that throws an exception that indicates a bug gives a row
/// with the status `error`. The other runs are not affected.
///
/// Guarantees: the content of a row does not depend on `jobs`, shards, or the order in which rows
/// are finished. A RunError of `run` (no memory) or of `records` (a full disk) stops the sweep and
/// is rethrown. InternalError unless jobs is positive. Apart from SweepRecords, memory does not
/// grow with the rows.
void RunRows(const StudyPoints& points, const RunScenarioOnce& run, SweepRecords& records,
             const SweepOptions& options);

/// Counts of the rows in some records.
struct SweepSummary {
  std::size_t rows = 0;
  std::size_t rows_expected = 0;  ///< more than `rows` if the study was interrupted
  std::size_t runs = 0;           ///< of these rows
  std::size_t passed = 0;         ///< rows that passed, or whose bisection found a value
  std::size_t refused = 0;        ///< rows whose scenario is invalid
  std::size_t errors = 0;         ///< rows whose run met a bug of the program

  [[nodiscard]] bool complete() const { return rows == rows_expected; }
};

/// Counts the rows of the shard.
SweepSummary Summarize(const SweepRecords& records, const Shard& shard = {});

/// Writes sweep.csv (parameters, seed, status, runs, outputs, reason; rows in grid order),
/// sweep.json (the study as it was run, and bisections) and manifest.json in one step
/// (ResultWriter), and removes the report.html of an earlier sweep. `stopped` is the reason for
/// rows that are missing on purpose. On a RunError, the earlier sweep remains.
SweepSummary WriteSweep(const SweepRecords& records, const Shard& shard, const OutputFolder& folder,
                        const std::string& stopped = "");

/// Adds the same files as a result of `writer`, which may get others before it commits, such as
/// falsify.json. It removes those of an earlier search or verification.
SweepSummary AddSweep(const SweepRecords& records, const Shard& shard, ResultWriter& writer,
                      const std::string& stopped = "");

/// Copies the rows of several record files of one study, such as those of its shards, to `records`.
///
/// InputError naming a file and the difference when it belongs to another study, and when two files
/// disagree on a row.
void MergeRecords(const std::vector<std::filesystem::path>& files, SweepRecords& records);

/// The numbers of the rows whose run folders are kept by a study that keeps the highest or lowest
/// values of an output: worst first; of equal values, the earlier row first.
std::vector<std::size_t> WorstRows(const SweepRecords& records);

/// The overrides of a row, in the order in which they apply to the scenario that the header names:
/// with them, a run reproduces the row. InputError when there is no such row.
std::vector<Override> OverridesOfRow(const SweepRecords& records, std::size_t row);

/// The missing rows, counted from 0: "3, 17 to 20".
std::string MissingRows(const SweepRecords& records);

/// The result of a study with few rows, in memory.
struct SweepResult {
  TextTable table{{"status"}};         ///< as sweep.csv
  nlohmann::ordered_json description;  ///< as sweep.json
  SweepSummary summary;
};

/// RunRows for all rows, in memory.
SweepResult RunSweep(const StudyPoints& points, const RunScenarioOnce& run,
                     const SweepOptions& options);

}  // namespace trackbed
