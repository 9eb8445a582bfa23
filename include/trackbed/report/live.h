#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/drive/run_log.h"

/// The page of a run in progress, and the messages with which it grows.
namespace trackbed {

/// The page of a report that grows with its run. `data` is ReportData of one run folder in which
/// each plant's log has its first row: a run that was interrupted at once. The page has no figures
/// and no verdict. It connects to the WebSocket `live` of its server; its Content-Security-Policy
/// allows that in addition to what every report may do. `id` distinguishes runs on that server: the
/// page reloads when the server announces another id.
std::string LivePage(const nlohmann::ordered_json& data, const std::string& id);

/// Rows of one plant as JSON arrays of numbers, with the order and rounding of the channels in the
/// page's data: a page with all rows of a run equals the run's report.
class LiveRows {
 public:
  /// `plant` is an entry of ReportData's runs[0].plants.
  explicit LiveRows(const nlohmann::ordered_json& plant);

  /// The last row of the log.
  [[nodiscard]] std::string LastRow(const RunLog& log) const;

  /// Row `row` of the configurations for the replay, to 0.1 mm and 1e-4 rad; empty if the page has
  /// no replay.
  [[nodiscard]] std::string Pose(const Table& configurations, std::size_t row) const;

  /// {from, x, y}: when a plan took effect, and points at most 1 m apart along it.
  static std::string NewPlan(const PlanChange& change);

 private:
  std::vector<std::string> log_columns_;
  std::vector<std::string> pose_columns_;
};

}  // namespace trackbed
