#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/falsify/falsify.h"

namespace trackbed {

/// A run of the search as its table has it.
struct SearchRun {
  std::size_t row = 0;
  std::string status;
  std::optional<double> robustness;
  std::string limit;
  std::string reason;

  [[nodiscard]] bool violated() const { return status == "failed" || status == "no_plan"; }
};

/// The columns of the table.
std::vector<std::string> SearchColumns(const Study& study);

/// Runs points, each once, and keeps a row of each.
class SearchRuns {
 public:
  SearchRuns(const CheckedSearch& search, SweepRecords& records, const FalsifyOptions& options)
      : search_(search), records_(records), options_(options) {}

  /// One for each point; none if it was interrupted. Points whose rows are not there are run in
  /// parallel, and are counted.
  std::optional<std::vector<SearchRun>> Run(const std::vector<UnitPoint>& points,
                                            const char* phase);

  /// Whether a run of the point is known.
  [[nodiscard]] bool Has(const UnitPoint& point) const;
  [[nodiscard]] std::size_t count() const { return next_; }

 private:
  /// The run of a row that the records have.
  [[nodiscard]] SearchRun FromRecords(std::size_t row, const std::vector<std::string>& texts) const;
  [[nodiscard]] bool RunRow(std::size_t row, const UnitPoint& point, const char* phase);
  [[nodiscard]] std::vector<std::string> Texts(const UnitPoint& point) const;

  const CheckedSearch& search_;
  SweepRecords& records_;
  const FalsifyOptions& options_;
  std::map<std::vector<std::string>, SearchRun> known_;  // by the values of the keys
  std::size_t next_ = 0;                                 // row
  std::mutex mutex_;                                     // of the progress
};

}  // namespace trackbed
