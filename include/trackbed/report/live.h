#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/drive/run_log.h"

/// Makes the web page of a run in progress, and the messages that add new data to the page.
namespace trackbed {

/// Formats the log rows of one plant as JSON arrays of numbers, in the same order and with the same
/// rounding as the channels in the page's data. Because order and rounding are those of the report,
/// a live page that has received all rows of a run equals the run's report.
class LiveRows {
 public:
  /// The argument `plant` is the plant's entry in the list runs[0].plants of ReportData.
  explicit LiveRows(const nlohmann::ordered_json& plant);

  /// Formats the last row of the plant's log.
  [[nodiscard]] std::string LastRow(const RunLog& log) const;

  /// Formats the car's configuration in row `row` for the 3D replay, rounded to 0.1 mm and 1e-4
  /// rad. Returns an empty text if the page has no 3D replay.
  [[nodiscard]] std::string Pose(const Table& configurations, std::size_t row) const;

  /// Formats a new plan as the JSON object {from, x, y}. The member `from` is the time at which the
  /// plan was adopted. The members `x` and `y` are the coordinates of points along the plan, which
  /// are at most 1 m apart.
  static std::string NewPlan(const PlanChange& change);

 private:
  std::vector<std::string> log_columns_;
  std::vector<std::string> pose_columns_;
};

}  // namespace trackbed
