#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/drive/run_log.h"

/// The page of a run in progress, and the messages that extend the page.
namespace trackbed {

/// The page of a report that grows with its run. `data` is the ReportData of a run folder in which
/// each plant's log has only its first row. The page has no figures and no verdict. The page
/// connects to the WebSocket `live` of its server. The page's Content-Security-Policy allows this
/// connection, in addition to the rights of every report. The `id` distinguishes runs on that
/// server: the page reloads when the server announces another id.
std::string LivePage(const nlohmann::ordered_json& data, const std::string& id);

/// Rows of one plant as JSON arrays of numbers, with the order and rounding of the channels in the
/// page's data: a page with all rows of a run equals the run's report.
class LiveRows {
 public:
  /// Makes the messages of a plant. `plant` is an entry of ReportData's runs[0].plants.
  explicit LiveRows(const nlohmann::ordered_json& plant);

  /// Formats the last row of the log.
  [[nodiscard]] std::string LastRow(const RunLog& log) const;

  /// Formats row `row` of the configurations for the replay, to 0.1 mm and 1e-4 rad. Empty if the
  /// page has no replay.
  [[nodiscard]] std::string Pose(const Table& configurations, std::size_t row) const;

  /// Formats a new plan as {from, x, y}: the time at which it took effect, and points at most 1 m
  /// apart along it.
  static std::string NewPlan(const PlanChange& change);

 private:
  std::vector<std::string> log_columns_;
  std::vector<std::string> pose_columns_;
};

}  // namespace trackbed
