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

/// Searches the keys of a study for a run that fails, and makes what it finds as small as it gets.
namespace trackbed {

/// A study whose keys can be searched.
struct CheckedSearch {
  Study study;
  CheckedStudy runs;  ///< of a sample in its box: cars and inputs
  SearchSpace space;
};

/// InputError as CheckStudy, where no point of a sample of 64 is good, and as SearchSpace; or when
/// the study has no `search`.
CheckedSearch CheckSearch(Study study);

/// What tells the records of the search from those of others. A row is a run, in the order in which
/// they were proposed: the keys, `status`, `robustness`, what decides it, the `phase` of the search
/// (nominal, search, shrink), the outputs and the reason.
nlohmann::ordered_json FalsifyHeader(const CheckedSearch& search);

struct FalsifyOptions {
  int jobs = 1;                         ///< runs at the same time, at least 1
  std::function<bool()> interrupted{};  ///< asked before each run, by any thread
  /// Called after each run with its row, by one thread at a time.
  std::function<void(std::size_t row)> progress{};
  /// Of the search, wall clock [s]: it ends with the first batch that is finished after that. The
  /// result then depends on the machine.
  std::optional<double> time_limit{};
};

/// A point that was run.
struct SearchedPoint {
  std::size_t row = 0;  ///< of the table
  UnitPoint point;
  std::vector<Setting> settings;
  double robustness = 0.0;
  std::string limit;   ///< what decides it
  std::string reason;  ///< of one that failed
};

enum class FalsifyStatus {
  kBroken,        ///< a run failed
  kNotFalsified,  ///< none of those that were run
  kInterrupted,
};

/// "broken", "not_falsified", "interrupted": the spelling of falsify.json.
const char* ToString(FalsifyStatus status);

struct FalsifyResult {
  FalsifyStatus status = FalsifyStatus::kNotFalsified;
  std::size_t runs = 0;         ///< of the search, that of the nominal point among them
  std::size_t shrink_runs = 0;  ///< after it
  std::size_t violations = 0;   ///< of the runs of the search
  std::size_t refused = 0;      ///< points without a scenario
  std::size_t errors = 0;       ///< runs that met a bug of the program
  bool out_of_time = false;
  std::optional<SearchedPoint> first;           ///< the first violation
  std::optional<SearchedPoint> least;           ///< the lowest robustness of the search
  std::optional<SearchedPoint> counterexample;  ///< the nearest violation to the nominal point
  Shrunk shrunk;                                ///< its margins, with a counterexample
};

/// Runs the nominal point, then the points that the search proposes, and shrinks the violation that
/// is nearest to the nominal point; unless that one fails itself, which ends it.
///
/// Appends each run to `records` (FalsifyHeader), and takes what is there instead of running it
/// again: the same call goes on where one was interrupted.
///
/// Guarantees: the same result for any number of jobs, interrupted or not, unless there is a time
/// limit; the counterexample was run and failed. Without one nothing is proved. Points without a
/// scenario, and runs that end with an exception, have a row and no robustness.
///
/// Errors: InputError when the scenario expects nothing; RunError of `records` and of runs.
FalsifyResult Falsify(const CheckedSearch& search, SweepRecords& records,
                      const FalsifyOptions& options = {});

/// The same in memory.
FalsifyResult Falsify(const CheckedSearch& search, const FalsifyOptions& options = {});

/// falsify.json.
nlohmann::ordered_json ToJson(const FalsifyResult& result, const CheckedSearch& search);

/// The counterexample once more, as a whole run. InternalError unless it fails as it did.
RunResult RunCounterexample(const FalsifyResult& result, const CheckedSearch& search);

}  // namespace trackbed
