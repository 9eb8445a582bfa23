#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/drive/run_log.h"

/// The page of a run that goes on, and the texts with which it grows.
namespace trackbed {

/// The page of a report that grows with its run. `data` is ReportData of one run folder, in which
/// each plant's log has its first row: a run that was interrupted at once. The page has no figures
/// and no verdict; it connects to the WebSocket `live` of the server that it came from, which its
/// Content-Security-Policy allows besides what it allows to every report. `id` tells the run from
/// others on that server: a page that is told of another one loads itself anew.
std::string LivePage(const nlohmann::ordered_json& data, const std::string& id);

/// Rows of one plant as JSON arrays of numbers, in the order of the channels that the data of the
/// page has of it, and rounded as there: a page with all rows of a run has what its report has.
class LiveRows {
 public:
  /// `plant` is an entry of ReportData's runs[0].plants.
  explicit LiveRows(const nlohmann::ordered_json& plant);

  /// The last row of the log.
  [[nodiscard]] std::string LastRow(const RunLog& log) const;

  /// Row `row` of the configurations for the replay, to 0.1 mm and 1e-4 rad; empty when the page
  /// has no replay.
  [[nodiscard]] std::string Pose(const Table& configurations, std::size_t row) const;

  /// {from, x, y}: when a plan took effect, and points at most 1 m apart along it.
  static std::string NewPlan(const PlanChange& change);

 private:
  std::vector<std::string> log_columns_;
  std::vector<std::string> pose_columns_;
};

}  // namespace trackbed
