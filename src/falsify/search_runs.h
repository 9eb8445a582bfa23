#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/falsify/falsify.h"

namespace trackbed {

/// A run of the search, as recorded in the search's table.
struct SearchRun {
  std::size_t row = 0;
  std::string status;
  std::optional<double> robustness;
  std::string limit;
  std::string reason;

  [[nodiscard]] bool violated() const { return status == "failed" || status == "no_plan"; }
};

/// Columns of the table of a search.
std::vector<std::string> SearchColumns(const Study& study);

/// Runs each point once and records its row.
class SearchRuns {
 public:
  SearchRuns(const CheckedSearch& search, SweepRecords& records, const FalsifyOptions& options)
      : search_(search), records_(records), options_(options) {}

  /// Returns one run per point, or none if interrupted. Runs missing points in parallel and counts
  /// the new runs.
  std::optional<std::vector<SearchRun>> Run(const std::vector<UnitPoint>& points,
                                            const char* phase);

  /// Whether the run of `point` is known.
  [[nodiscard]] bool Has(const UnitPoint& point) const;
  [[nodiscard]] std::size_t count() const { return next_; }

 private:
  /// Restores a run from its recorded row.
  [[nodiscard]] SearchRun FromRecords(std::size_t row, const std::vector<std::string>& texts) const;
  [[nodiscard]] bool RunRow(std::size_t row, const UnitPoint& point, const char* phase);
  [[nodiscard]] std::vector<std::string> Texts(const UnitPoint& point) const;

  const CheckedSearch& search_;
  SweepRecords& records_;
  const FalsifyOptions& options_;
  std::map<std::vector<std::string>, SearchRun> known_;  // Runs, keyed by the values of the
                                                         // searched keys.
  std::size_t next_ = 0;                                 // Number of the next row.
  std::mutex mutex_;                                     // Guards the reports of progress.
};

}  // namespace trackbed
