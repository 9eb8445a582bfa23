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
#include "trackbed/core/text_table.h"
#include "trackbed/scenario/study.h"

/// Runs a study and makes one table of it.
namespace trackbed {

/// Results of a run as a table shows them, by their dotted paths: `metrics.<plant>.…`,
/// `between.<plant>.<plant>.…`, `verdict.passed`, `verdict.failures`, `plan.status`,
/// `plan.length_m`; the names are those of metrics.json, elements of lists are `[0]`, `[1]`, ….
/// What a run on one plant has under that plant's name it has as `metrics.*.…` too, so that a study
/// of plants needs one column for each result.
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
};

/// Runs a scenario, on any thread; nothing when it was interrupted.
using RunScenarioOnce = std::function<std::optional<RunOutcome>(const Scenario& scenario)>;

/// A study that has been validated as far as possible before it is run. Immutable, and shared
/// between threads.
struct CheckedStudy {
  Study study;
  std::vector<StudyPoint> points;
  std::unique_ptr<CarCache> cars;  ///< never null
};

/// Reads every point of the study's grid, compiles the cars, makes the plants and checks the
/// outputs. InputError with the problems of all points, of all cars, or of all outputs with the
/// nearest path.
///
/// With BadPoints::kKeep the points that have such a problem are refused (StudyPoint), and others
/// are not affected, unless there are none.
CheckedStudy CheckStudy(Study study, BadPoints bad_points = BadPoints::kThrow);

/// Plans, drives, measures and judges a scenario of the study.
std::optional<RunOutcome> DriveOnce(const CheckedStudy& checked, const Scenario& scenario,
                                    const std::function<bool()>& interrupted = {});

struct SweepOptions {
  int jobs = 1;                                   ///< runs at the same time, at least 1
  std::function<void(double fraction)> progress;  ///< called after each row, by one thread at once
  std::function<bool()> interrupted;              ///< asked before each run, by any thread
};

struct SweepResult {
  TextTable table{{"status"}};  ///< sweep.csv: parameters, seed, status, runs, outputs, reason
  nlohmann::ordered_json description;  ///< sweep.json: the study as it was run, and bisections
  std::size_t rows_expected = 0;       ///< more than the table has when it was interrupted
  std::size_t runs = 0;                ///< of the table's rows
  std::size_t passed = 0;              ///< rows that passed, or whose bisection found a value
  std::size_t refused = 0;             ///< rows whose scenario is wrong
  std::size_t errors = 0;              ///< rows whose run met a bug of the program

  [[nodiscard]] bool complete() const { return table.rows().size() == rows_expected; }
};

/// Runs the points of a study, each `repeat` times with its seed counted up, or bisects at each.
/// Rows are in the grid's order, those that an interruption left unfinished absent.
///
/// A point that is refused, and a run that throws an InputError, have a row with the status
/// `refused` and the first problem as the reason; a run that throws what tells of a bug, one with
/// the status `error`. The other runs are not affected.
///
/// Guarantees: the result does not depend on `jobs`. A RunError of `run` (a full disk, no memory)
/// stops the sweep and is thrown on. InternalError unless jobs is positive.
SweepResult RunSweep(const Study& study, const std::vector<StudyPoint>& points,
                     const RunScenarioOnce& run, const SweepOptions& options);

/// Writes sweep.csv, sweep.json and manifest.json, all at once (ResultWriter), and removes the
/// report.html of an earlier sweep. RunError: the earlier sweep is still there then.
void WriteSweep(const SweepResult& sweep, const OutputFolder& folder);

}  // namespace trackbed
