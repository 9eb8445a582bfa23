#include "trackbed/report/live.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "src/report/numbers.h"
#include "src/report/run_data.h"

namespace trackbed {

using nlohmann::ordered_json;

LiveRows::LiveRows(const ordered_json& plant) {
  for (const auto& channel : plant.at("log").items()) {
    log_columns_.emplace_back(ColumnOfChannel(channel.key()));
  }
  if (plant.contains("motion")) {
    pose_columns_.emplace_back("t_s");
    for (const auto& channel : plant.at("motion").at("channels").items()) {
      pose_columns_.push_back(channel.key());
    }
  }
}

std::string LiveRows::LastRow(const RunLog& log) const {
  const Table table = ToTable({.plant = log.plant,
                               .controller_columns = log.controller_columns,
                               .rows = {log.rows.back()},
                               .changes = {},
                               .configurations = Table({"t_s"})});
  ordered_json cells = ordered_json::array();
  for (const std::string& column : log_columns_) {
    cells.push_back(Rounded(table.Column(column).front()));
  }
  return cells.dump();
}

std::string LiveRows::Pose(const Table& configurations, std::size_t row) const {
  if (pose_columns_.empty()) {
    return "";
  }
  constexpr double kSteps = 1e4;  // number of quantization steps of poses per meter or radian
  ordered_json cells = ordered_json::array();
  for (const std::string& column : pose_columns_) {
    const int found = configurations.Find(column);
    const double value = configurations.at(row, static_cast<std::size_t>(found));
    cells.push_back(std::round(value * kSteps) / kSteps);
  }
  return cells.dump();
}

std::string LiveRows::NewPlan(const PlanChange& change) {
  constexpr double kSpacing = 1.0;  // [m]
  ordered_json plan{
      {"from", Rounded(change.time)}, {"x", ordered_json::array()}, {"y", ordered_json::array()}};
  for (const PathPoint& point : change.plan.reference.path.Sample(kSpacing)) {
    plan["x"].push_back(Rounded(point.pose.x));
    plan["y"].push_back(Rounded(point.pose.y));
  }
  return plan.dump();
}

}  // namespace trackbed
