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
#include "trackbed/analysis/sweep_check.h"
#include "trackbed/analysis/sweep_records.h"
#include "trackbed/core/text_table.h"
#include "trackbed/scenario/study_points.h"

/// Runs a study and writes its results to one table.
namespace trackbed {

/// The part of a study's rows that one process runs: every `count`-th row, starting at the row with
/// the number `index`, where 1 is the first row.
struct Shard {
  int index = 1;
  int count = 1;

  [[nodiscard]] bool Has(std::size_t row) const {
    return row % static_cast<std::size_t>(count) == static_cast<std::size_t>(index - 1);
  }
};

struct SweepOptions {
  int jobs = 1;  ///< Number of scenario runs that are executed at the same time, at least 1.
  /// Receives the finished fraction of the rows to run; called when a row is finished, by one
  /// thread at a time.
  std::function<void(double fraction)> progress;
  /// Returns true to stop the sweep; called before each run, by any thread.
  std::function<bool()> interrupted;
  Shard shard{};  ///< The part of the rows to run; rows outside of the shard are skipped.
  /// Statuses of rows to run again. If `again` is not empty, only recorded rows with a status in
  /// `again` are run.
  std::vector<std::string> again{};
  /// Receives the outcome of each run, in any thread, before the row of the run is appended to the
  /// records. The callback `finished` is not called for bisections.
  std::function<void(std::size_t row, const RunOutcome& outcome)> finished{};
  /// Wanted half-width of the pass rate's confidence interval, from 0.001 to 0.5. The sweep stops
  /// as soon as the confidence interval of the pass rate at each point of the grid has at most the
  /// half-width `until_pass_rate`. The option `until_pass_rate` needs a study with a sample and
  /// without bisection. The confidence interval is checked after every kUntilBatch points of the
  /// sample, so that the result does not depend on `jobs`.
  std::optional<double> until_pass_rate{};
};

inline constexpr std::size_t kUntilBatch = 100;

/// Returns the number of rows of a study: `repeat` rows for each point.
std::size_t CountRows(const StudyPoints& points);

/// Returns the header of a study's records, which identifies the study. The header consists of the
/// study's description, its columns, the versions of the programs, and `inputs`, the hashes of the
/// input files.
nlohmann::ordered_json SweepHeader(const StudyPoints& points,
                                   const std::map<std::string, std::string>& inputs = {});

/// Runs the rows of a study that are missing in `records`, and appends each row to `records` as
/// soon as the row is finished. Each point of the study yields `repeat` rows with consecutive
/// seeds, or one bisection. After an interruption, `records` lacks the unfinished rows.
///
/// The row of an invalid point has the status `refused`, and the first problem as the reason. If a
/// run throws InputError, its row also has the status `refused`. If a run throws an exception that
/// indicates a bug, its row has the status `error`. An exception in one run does not affect the
/// other runs of the sweep.
///
/// Guarantees: the content of a row does not depend on `jobs`, shards, or the order in which rows
/// are finished. If `run` throws RunError (out of memory) or `records` throws RunError (full disk),
/// the sweep stops and rethrows the error. Throws InternalError unless `jobs` is positive. Apart
/// from the memory of SweepRecords, the required memory does not grow with the number of rows.
void RunRows(const StudyPoints& points, const RunScenarioOnce& run, SweepRecords& records,
             const SweepOptions& options);

/// Numbers of rows in the records of a study, by status.
struct SweepSummary {
  std::size_t rows = 0;
  std::size_t rows_expected = 0;  ///< Number of rows of the complete study.
  std::size_t runs = 0;           ///< Number of scenario runs in the recorded rows.
  std::size_t passed = 0;         ///< Number of rows that passed, or whose bisection found a value.
  std::size_t refused = 0;        ///< Number of rows whose scenario is invalid.
  std::size_t errors = 0;         ///< Number of rows whose run revealed a bug in the program.

  [[nodiscard]] bool complete() const { return rows == rows_expected; }
};

/// Counts the recorded rows that belong to the given shard (part of the study).
SweepSummary Summarize(const SweepRecords& records, const Shard& shard = {});

/// Writes sweep.csv (parameters, seed, status, runs, outputs, reason; rows in grid order),
/// sweep.json (the study as it was run, and bisections) and manifest.json. WriteSweep writes all
/// files in one step (ResultWriter), and removes the report.html of an earlier sweep. If rows are
/// missing on purpose, `stopped` states the reason. If writing fails with a RunError, the files of
/// the earlier sweep remain.
SweepSummary WriteSweep(const SweepRecords& records, const Shard& shard, const OutputFolder& folder,
                        const std::string& stopped = "");

/// Adds the files of WriteSweep to the ResultWriter `writer`. Before calling ResultWriter::Commit,
/// the caller may add further files to the result, such as falsify.json. The files that an earlier
/// search or verification wrote to the output folder are removed.
SweepSummary AddSweep(const SweepRecords& records, const Shard& shard, ResultWriter& writer,
                      const std::string& stopped = "");

/// Merges several record files of one study, such as those of its shards, into `records`.
///
/// Throws InputError, naming the file and the difference, if a file belongs to another study.
/// Throws InputError if two files contain different content for the same row.
void MergeRecords(const std::vector<std::filesystem::path>& files, SweepRecords& records);

/// Returns the numbers of the rows whose run folders the study keeps, which are the rows with the
/// highest or lowest values of an output. The worst row comes first; rows with equal values keep
/// their order.
std::vector<std::size_t> WorstRows(const SweepRecords& records);

/// Returns the overrides of a row, in the order in which they are applied. Running the scenario
/// named in the header with the overrides of a row reproduces the row. Throws InputError if the
/// study has no row of this number.
std::vector<Override> OverridesOfRow(const SweepRecords& records, std::size_t row);

/// Returns the numbers of the missing rows, counted from 0, as text such as "3, 17 to 20".
std::string MissingRows(const SweepRecords& records);

/// The result of a study with few rows, in memory.
struct SweepResult {
  TextTable table{{"status"}};         ///< The content of the table sweep.csv.
  nlohmann::ordered_json description;  ///< The content of sweep.json.
  SweepSummary summary;
};

/// Runs all rows of a study in the same way as RunRows, but keeps the rows in memory: for programs
/// that use the table without a folder. `trackbed sweep` writes the rows to a file by RunRows.
SweepResult RunSweep(const StudyPoints& points, const RunScenarioOnce& run,
                     const SweepOptions& options);

}  // namespace trackbed
