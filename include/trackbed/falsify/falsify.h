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
  CheckedStudy runs;  ///< cars and inputs of a sample in the box
  SearchSpace space;
};

/// Validates a study for searching. InputError as SearchSpace; as CheckStudy, if no point of a
/// sample of 64 is valid; and when the study has no `search`.
CheckedSearch CheckSearch(Study study);

/// Identifies the records of the search. Rows are runs, in the order in which they were proposed:
/// the keys, `status`, `robustness`, the decisive check, the `phase` of the search (nominal,
/// search, shrink), the outputs and the reason.
nlohmann::ordered_json FalsifyHeader(const CheckedSearch& search);

struct FalsifyOptions {
  int jobs = 1;                         ///< runs at the same time, at least 1
  std::function<bool()> interrupted{};  ///< asked before each run, by any thread
  /// Called after each run with its row, by one thread at a time.
  std::function<void(std::size_t row)> progress{};
  /// Limit on the search's wall-clock time [s]: the search ends with the first batch that finishes
  /// after it. The result then depends on the machine.
  std::optional<double> time_limit{};
};

/// A point that was run.
struct SearchedPoint {
  std::size_t row = 0;  ///< of the table
  UnitPoint point;
  std::vector<Setting> settings;
  double robustness = 0.0;
  std::string limit;   ///< the decisive check
  std::string reason;  ///< why the run failed; empty if it passed
};

enum class FalsifyStatus {
  kBroken,        ///< a run failed
  kNotFalsified,  ///< no run failed
  kInterrupted,
};

/// "broken", "not_falsified", "interrupted": the spelling of falsify.json.
const char* ToString(FalsifyStatus status);

struct FalsifyResult {
  FalsifyStatus status = FalsifyStatus::kNotFalsified;
  std::size_t runs = 0;         ///< of the search, including the nominal point
  std::size_t shrink_runs = 0;  ///< after the search
  std::size_t violations = 0;   ///< of the runs of the search
  std::size_t refused = 0;      ///< points without a scenario
  std::size_t errors = 0;       ///< runs that hit a bug of the program
  bool out_of_time = false;
  std::optional<SearchedPoint> first;           ///< the first violation
  std::optional<SearchedPoint> least;           ///< the lowest robustness of the search
  std::optional<SearchedPoint> counterexample;  ///< the nearest violation to the nominal point
  ShrinkResult shrunk;                          ///< margins of the counterexample, if one was found
};

/// Runs the nominal point, then the points that the search proposes, and shrinks the violation
/// nearest to the nominal point. If the nominal point fails, the search ends at once.
///
/// Appends each run to `records` (FalsifyHeader) and reuses rows that are already there: calling it
/// again resumes an interrupted search.
///
/// Guarantees: the same result for any number of jobs, interrupted or not, unless there is a time
/// limit; the counterexample was run and failed. Without a counterexample nothing is proved. Points
/// without a scenario, and runs that end with an exception, have a row but no robustness.
///
/// Errors: InputError when the scenario expects nothing; RunError of `records` and of runs.
FalsifyResult Falsify(const CheckedSearch& search, SweepRecords& records,
                      const FalsifyOptions& options = {});

/// As above, with records in memory.
FalsifyResult Falsify(const CheckedSearch& search, const FalsifyOptions& options = {});

/// The content of falsify.json.
nlohmann::ordered_json ToJson(const FalsifyResult& result, const CheckedSearch& search);

/// Repeats the counterexample as a complete run. InternalError unless it fails as it did before.
RunResult RunCounterexample(const FalsifyResult& result, const CheckedSearch& search);

}  // namespace trackbed
