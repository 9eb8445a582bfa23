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

/// Results of a run for a table, by dotted path: `metrics.<plant>.…`, `between.<plant>.<plant>.…`,
/// `verdict.passed`, `verdict.failures`, `verdict.robustness` (RobustnessOf), `plan.status`,
/// `plan.length_m` and the other PathProperties(), `timing.planning_s` (which differs between
/// runs). The names are the same as in metrics.json. List elements are written `[0]`, `[1]`, ….
/// Results of a run on a single plant are also listed as `metrics.*.…`, so that a study that varies
/// the plant needs only one column for each result.
using Outputs = std::map<std::string, std::string>;

Outputs CollectOutputs(const RunResult& result);

/// The paths of all outputs that runs of the scenario may have, sorted.
std::vector<std::string> PossibleOutputs(const Scenario& scenario);

/// The result of one run.
struct RunOutcome {
  std::string status;  ///< Status "passed", "failed", "driven" (no expectations), or "no_plan".
  bool passed = false;
  std::string reason{};  ///< Reason why the run failed or has no plan.
  Outputs outputs;
  std::optional<RunResult> result{};  ///< Complete result, if DriveOnce ran the scenario.
};

/// Function that runs a scenario, on any thread, and returns nullopt if interrupted.
using RunScenarioOnce = std::function<std::optional<RunOutcome>(const Scenario& scenario)>;

/// A study that has been validated as far as possible before its runs. A CheckedStudy is immutable,
/// so threads can share it.
struct CheckedStudy {
  StudyPoints points;
  std::unique_ptr<CarCache> cars;             ///< Cache of the compiled cars, never null.
  std::map<std::string, std::string> inputs;  ///< SHA-256 of the study's input files, by name.
};

/// Reads the points of the study (CheckPoints), compiles the cars, makes the plants and checks the
/// outputs. InputError listing the problems of the points or their cars. InputError listing all
/// unknown outputs, each with the most similar path. If `all` is true, every point must be valid;
/// otherwise, one valid point is enough.
CheckedStudy CheckStudy(Study study, bool all = true);

/// Plans, simulates, measures and judges a scenario of the study.
std::optional<RunOutcome> DriveOnce(const CheckedStudy& checked, const Scenario& scenario,
                                    const std::function<bool()>& interrupted = {});

/// The part of a study's rows that one process runs: every `count`-th row, starting at row `index`,
/// which counts from 1.
struct Shard {
  int index = 1;
  int count = 1;

  [[nodiscard]] bool Has(std::size_t row) const {
    return row % static_cast<std::size_t>(count) == static_cast<std::size_t>(index - 1);
  }
};

struct SweepOptions {
  int jobs = 1;  ///< Number of runs at the same time, at least 1.
  /// Called after each row, by one thread at a time.
  std::function<void(double fraction)> progress;
  /// Returns whether to stop; called before each run, by any thread.
  std::function<bool()> interrupted;
  Shard shard{};  ///< Rows outside of the shard are skipped.
  /// If not empty: runs the rows with these statuses again, instead of the missing rows.
  std::vector<std::string> again{};
  /// Called after each run, by any thread, before its row is appended. The callback `finished` is
  /// not called for bisections.
  std::function<void(std::size_t row, const RunOutcome& outcome)> finished{};
  /// Half-width of the pass rate's confidence interval, from 0.001 to 0.5. The sweep stops as soon
  /// as the interval at each point of the grid has at most this half-width. The option
  /// `until_pass_rate` needs a study with a sample and without bisection. The interval is checked
  /// after every kUntilBatch points of the sample, so that the result does not depend on `jobs`.
  std::optional<double> until_pass_rate{};
};

inline constexpr std::size_t kUntilBatch = 100;

/// The number of rows of a study: `repeat` rows for each point.
std::size_t CountRows(const StudyPoints& points);

/// Identifies the records of a study by its description, its columns, the versions of the programs,
/// and `inputs`, the hashes of its input files.
nlohmann::ordered_json SweepHeader(const StudyPoints& points,
                                   const std::map<std::string, std::string>& inputs = {});

/// Runs the rows of a study that are missing in `records`, and appends each row as soon as it is
/// finished. Each point gives `repeat` rows with consecutive seeds, or a bisection. After an
/// interruption, unfinished rows are missing.
///
/// An invalid point gives a row with the status `refused` and the first problem as the reason. A
/// run that throws an InputError also gives a row with the status `refused`. An exception that
/// indicates a bug gives a row with the status `error`. Other runs of the sweep are not affected.
///
/// Guarantees: the content of a row does not depend on `jobs`, shards, or the order in which rows
/// are finished. A RunError of `run` (out of memory) or of `records` (full disk) stops the sweep
/// and is rethrown. InternalError unless jobs is positive. Apart from SweepRecords, the memory does
/// not grow with the number of rows.
void RunRows(const StudyPoints& points, const RunScenarioOnce& run, SweepRecords& records,
             const SweepOptions& options);

/// Counts of the rows in the records of a study.
struct SweepSummary {
  std::size_t rows = 0;
  std::size_t rows_expected = 0;  ///< Number of rows of the complete study.
  std::size_t runs = 0;           ///< Number of runs in these rows.
  std::size_t passed = 0;         ///< Number of rows that passed, or whose bisection found a value.
  std::size_t refused = 0;        ///< Number of rows whose scenario is invalid.
  std::size_t errors = 0;         ///< Number of rows whose run revealed a bug in the program.

  [[nodiscard]] bool complete() const { return rows == rows_expected; }
};

/// Counts the rows of the shard.
SweepSummary Summarize(const SweepRecords& records, const Shard& shard = {});

/// Writes sweep.csv (parameters, seed, status, runs, outputs, reason; rows in grid order),
/// sweep.json (the study as it was run, and bisections) and manifest.json in one step
/// (ResultWriter), and removes the report.html of an earlier sweep. If rows are missing on purpose,
/// `stopped` is the reason. If writing fails with a RunError, the files of the earlier sweep
/// remain.
SweepSummary WriteSweep(const SweepRecords& records, const Shard& shard, const OutputFolder& folder,
                        const std::string& stopped = "");

/// Adds the files that WriteSweep writes to `writer`. The caller may add further files to the
/// result before the commit, such as falsify.json. Removes the files of an earlier search or
/// verification.
SweepSummary AddSweep(const SweepRecords& records, const Shard& shard, ResultWriter& writer,
                      const std::string& stopped = "");

/// Merges several record files of one study, such as those of its shards, into `records`.
///
/// InputError naming the file and the difference if a file belongs to another study. InputError if
/// two files disagree on a row.
void MergeRecords(const std::vector<std::filesystem::path>& files, SweepRecords& records);

/// Returns the numbers of the rows whose run folders the study keeps: the rows with the highest or
/// lowest values of an output. The worst row is first; rows with equal values keep their order.
std::vector<std::size_t> WorstRows(const SweepRecords& records);

/// Returns the overrides of a row, in their order of application. A run of the scenario in the
/// header with these overrides reproduces the row. InputError if there is no such row.
std::vector<Override> OverridesOfRow(const SweepRecords& records, std::size_t row);

/// Lists the numbers of the missing rows as text, counted from 0: "3, 17 to 20".
std::string MissingRows(const SweepRecords& records);

/// The result of a study with few rows, in memory.
struct SweepResult {
  TextTable table{{"status"}};         ///< The content of sweep.csv.
  nlohmann::ordered_json description;  ///< The content of sweep.json.
  SweepSummary summary;
};

/// Runs all rows as RunRows does, but keeps them in memory.
SweepResult RunSweep(const StudyPoints& points, const RunScenarioOnce& run,
                     const SweepOptions& options);

}  // namespace trackbed
