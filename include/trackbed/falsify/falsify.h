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

/// Searches the keys of a study for a run that fails, and shrinks the counterexample.
namespace trackbed {

/// A study whose keys can be searched.
struct CheckedSearch {
  Study study;
  CheckedStudy runs;  ///< Cars and input files of the study, checked at a sample of points.
  SearchSpace space;
};

/// Validates a study for a search. InputError if the study has no `search`, or if no point of a
/// sample of 64 is valid. Also throws the InputErrors of SearchSpace and CheckStudy.
CheckedSearch CheckSearch(Study study);

/// Identifies the records of the search. Each row is a run; the rows have the order in which the
/// search proposed the points. A row has the keys, `status`, `robustness`, the decisive check, the
/// `phase` of the search (nominal, search, shrink), the outputs and the reason.
nlohmann::ordered_json FalsifyHeader(const CheckedSearch& search);

struct FalsifyOptions {
  int jobs = 1;  ///< Number of runs at the same time, at least 1.
  /// Returns whether to stop; called before each run, by any thread.
  std::function<bool()> interrupted{};
  /// Called after each run with its row, by one thread at a time.
  std::function<void(std::size_t row)> progress{};
  /// Limit on the wall-clock time of the search [s]. The search ends with the first batch that
  /// finishes after the limit, so that the result of the search depends on the machine.
  std::optional<double> time_limit{};
};

/// A point of the search that was run.
struct SearchedPoint {
  std::size_t row = 0;  ///< Row of the table.
  UnitPoint point;
  std::vector<Setting> settings;
  double robustness = 0.0;
  std::string limit;   ///< Name of the decisive check.
  std::string reason;  ///< Why the run failed; empty if it passed.
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
  std::size_t shrink_runs = 0;  ///< Number of runs of the shrinking after the search.
  std::size_t violations = 0;   ///< Number of violations among the runs of the search.
  std::size_t refused = 0;      ///< Number of points with an invalid scenario.
  std::size_t errors = 0;       ///< Number of runs that revealed a bug in the program.
  bool out_of_time = false;
  std::optional<SearchedPoint> first;           ///< The first violation.
  std::optional<SearchedPoint> least;           ///< Point of the search with the lowest robustness.
  std::optional<SearchedPoint> counterexample;  ///< Violation nearest to the nominal point.
  ShrinkResult shrunk;  ///< Shrunk counterexample with its margins, if one was found.
};

/// Searches for a violation and shrinks the violation nearest to the nominal point. Runs the
/// nominal point first, then the points that the search proposes. If the nominal point fails, the
/// search ends.
///
/// Appends each run to `records` (FalsifyHeader) and reuses the rows that `records` already
/// contains, so that calling Falsify again resumes an interrupted search.
///
/// Guarantees: the result does not depend on the number of jobs or on interruptions, unless there
/// is a time limit. The counterexample was run and failed. A search without a counterexample proves
/// nothing. Points with an invalid scenario, and runs that end with an exception, have a row but no
/// robustness.
///
/// Errors: InputError if the scenario has no expectations; the RunErrors of `records` and of runs.
FalsifyResult Falsify(const CheckedSearch& search, SweepRecords& records,
                      const FalsifyOptions& options = {});

/// As Falsify above, with records in memory.
FalsifyResult Falsify(const CheckedSearch& search, const FalsifyOptions& options = {});

/// Returns the content of falsify.json.
nlohmann::ordered_json ToJson(const FalsifyResult& result, const CheckedSearch& search);

/// Repeats the counterexample as a complete run. InternalError unless the counterexample fails in
/// the same way as in the search.
RunResult RunCounterexample(const FalsifyResult& result, const CheckedSearch& search);

}  // namespace trackbed
