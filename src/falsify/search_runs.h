#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/falsify/falsify.h"

namespace trackbed {

/// Result of a run of the search, as recorded in the table of runs.
struct SearchRun {
  std::size_t row = 0;
  std::string status;
  std::optional<double> robustness;
  std::string limit;
  std::string reason;

  [[nodiscard]] bool violated() const { return status == "failed" || status == "no_plan"; }
};

/// Returns the column names of a search's table of runs.
std::vector<std::string> SearchColumns(const Study& study);

/// Runs each point of a search once and records the result as a row of the table of runs.
class SearchRuns {
 public:
  SearchRuns(const CheckedSearch& search, SweepRecords& records, const FalsifyOptions& options)
      : search_(search), records_(records), options_(options) {}

  /// Returns the results of the runs at all `points`, or nullopt if the runs were interrupted.
  /// Points that have not been run before are run in parallel.
  std::optional<std::vector<SearchRun>> Run(const std::vector<UnitPoint>& points,
                                            const char* phase);

  /// Returns whether the point has already been run, so that its result is known.
  [[nodiscard]] bool Has(const UnitPoint& point) const;
  [[nodiscard]] std::size_t count() const { return next_; }

 private:
  /// Reads the result of a run from its recorded row.
  [[nodiscard]] SearchRun FromRecords(std::size_t row, const std::vector<std::string>& texts) const;
  [[nodiscard]] bool RunRow(std::size_t row, const UnitPoint& point, const char* phase);
  [[nodiscard]] std::vector<std::string> Texts(const UnitPoint& point) const;

  const CheckedSearch& search_;
  SweepRecords& records_;
  const FalsifyOptions& options_;
  // Known results of runs, keyed by the values of the searched keys.
  std::map<std::vector<std::string>, SearchRun> known_;
  std::size_t next_ = 0;  // Number of the next row that is added to the table of runs.
  std::mutex mutex_;      // Protects the progress reports of parallel runs.
};

}  // namespace trackbed
