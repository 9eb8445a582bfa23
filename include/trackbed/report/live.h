#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/drive/run_log.h"

/// Makes the page of a run in progress, and the messages that extend the page.
namespace trackbed {

/// Returns a report page that grows during its run. `data` is the ReportData of a run folder in
/// which each plant's log has only its first row. The page has neither metrics nor a verdict. The
/// page connects to the WebSocket `live` of its server. In addition to what every report may do,
/// the page's Content-Security-Policy allows this connection. The `id` identifies the run: if the
/// server announces another id, the page reloads.
std::string LivePage(const nlohmann::ordered_json& data, const std::string& id);

/// Formats the rows of one plant as JSON arrays of numbers, in the order and rounding of the
/// channels in the page's data. A live page with all rows of a run therefore equals the report of
/// the run.
class LiveRows {
 public:
  /// `plant` is the plant's entry in runs[0].plants of ReportData.
  explicit LiveRows(const nlohmann::ordered_json& plant);

  /// Formats the last row of the plant's log.
  [[nodiscard]] std::string LastRow(const RunLog& log) const;

  /// Formats the configuration in row `row` for the 3D replay, rounded to 0.1 mm and 1e-4 rad.
  /// Returns an empty text if the page has no replay.
  [[nodiscard]] std::string Pose(const Table& configurations, std::size_t row) const;

  /// Formats a new plan as {from, x, y}. `from` is the time at which the plan was adopted; x and y
  /// list points along the plan that are at most 1 m apart.
  static std::string NewPlan(const PlanChange& change);

 private:
  std::vector<std::string> log_columns_;
  std::vector<std::string> pose_columns_;
};

}  // namespace trackbed
