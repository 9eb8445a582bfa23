#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/sweep.h"
#include "trackbed/falsify/search_space.h"
#include "trackbed/falsify/shrink.h"

/// Searches for a counterexample, that is, values of a study's keys with which the run fails. After
/// the search, shrinks the counterexample toward the nominal values.
namespace trackbed {

/// A study that can be searched for a failing run.
struct CheckedSearch {
  Study study;
  /// Car models and input files of the study, which were checked at a sample of points.
  CheckedStudy runs;
  SearchSpace space;
};

/// Checks that a study can be searched for a failing run. Throws InputError if the study has no
/// section `search`, or if all 64 sampled points are invalid. Also throws InputError in the same
/// cases as SearchSpace and CheckStudy.
CheckedSearch CheckSearch(Study study);

/// Returns the header that identifies the records of a search. Each row of the records is one run;
/// the rows are in the order in which the search proposed the points. Each row contains the values
/// of the keys, `status`, `robustness`, the decisive check, the `phase` of the search (nominal,
/// search, shrink), the outputs, and the reason of a failure.
nlohmann::ordered_json FalsifyHeader(const CheckedSearch& search);

struct FalsifyOptions {
  int jobs = 1;  ///< Number of runs that are simulated at the same time, at least 1.
  /// Returns true to stop the search; called before each run, by any thread.
  std::function<bool()> interrupted{};
  /// Callback after each run, with the index of the run's row; only one thread at a time calls the
  /// callback.
  std::function<void(std::size_t row)> progress{};
  /// Limit on the wall-clock time of the search [s]. The search ends with the first batch of runs
  /// that finishes after the time limit, so the result of the search depends on the speed of the
  /// machine.
  std::optional<double> time_limit{};
};

/// A point of the search, and the result of the run at this point.
struct SearchedPoint {
  std::size_t row = 0;  ///< Index of the run's row in the records.
  UnitPoint point;
  std::vector<Setting> settings;
  double robustness = 0.0;
  std::string limit;   ///< Name of the check that determined the robustness.
  std::string reason;  ///< Reason why the run failed; empty if the run passed.
};

enum class FalsifyStatus {
  kBroken,        ///< A run failed.
  kNotFalsified,  ///< No run failed.
  kInterrupted,
};

/// Returns the name of a status as written in falsify.json: "broken", "not_falsified",
/// "interrupted".
const char* ToString(FalsifyStatus status);

struct FalsifyResult {
  FalsifyStatus status = FalsifyStatus::kNotFalsified;
  std::size_t runs = 0;         ///< Number of runs of the search, including the nominal point.
  std::size_t shrink_runs = 0;  ///< Number of runs to shrink the counterexample after the search.
  std::size_t violations = 0;   ///< Number of runs of the search that violated an expectation.
  /// Number of points of the search at which the scenario was invalid.
  std::size_t refused = 0;
  /// Number of runs of the search that ended by a bug in the program.
  std::size_t errors = 0;
  bool out_of_time = false;
  std::optional<SearchedPoint> first;  ///< The first violation.
  std::optional<SearchedPoint> least;  ///< Run of the search with the lowest robustness.
  /// Failed run of the search nearest to the nominal point.
  std::optional<SearchedPoint> counterexample;
  /// Shrunk counterexample and its margins; only meaningful if a counterexample was found.
  ShrinkResult shrunk;
};

/// Searches for runs that violate an expectation, and shrinks the violation nearest to the nominal
/// point. First simulates the nominal point, then the points that the search proposes. If the run
/// at the nominal point fails, the search ends immediately.
///
/// Appends each run to `records` (FalsifyHeader) and reuses the rows that `records` already
/// contains. Because of the reused rows, calling Falsify again resumes an interrupted search.
///
/// Guarantees: the result does not depend on the number of jobs or on interruptions, unless there
/// is a time limit. The returned counterexample was simulated and failed. If the search finds no
/// counterexample, this does not prove that none exists. Points with an invalid scenario, and runs
/// that end with an exception, have a row without a robustness.
///
/// Throws InputError if the scenario has no expectations. Throws RunError if `records` cannot be
/// written or if a run throws RunError.
FalsifyResult Falsify(const CheckedSearch& search, SweepRecords& records,
                      const FalsifyOptions& options = {});

/// Works like the function Falsify above, but keeps the records in memory.
FalsifyResult Falsify(const CheckedSearch& search, const FalsifyOptions& options = {});

/// Returns the result of a search in the format of falsify.json.
nlohmann::ordered_json ToJson(const FalsifyResult& result, const CheckedSearch& search);

/// Simulates the counterexample again and returns the complete run. Throws InternalError unless the
/// run fails in the same way as during the search.
RunResult RunCounterexample(const FalsifyResult& result, const CheckedSearch& search);

}  // namespace trackbed
