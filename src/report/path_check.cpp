#include "trackbed/report/path_check.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "src/report/numbers.h"
#include "trackbed/core/table.h"
#include "trackbed/core/version.h"
#include "trackbed/planning/path_file/path_file_planner.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMaxDemands = 4000;

ordered_json OrNull(double number) {
  return std::isfinite(number) ? ordered_json(number) : ordered_json();
}

/// Converts a limit of the car to JSON; the value 0 means that the limit is unknown and becomes
/// null.
ordered_json LimitJson(double limit) {
  return limit > 0.0 ? OrNull(limit) : ordered_json();
}

/// Maximum speed in the chart [m/s]; the chart is limited because the possible speed on a straight
/// is unlimited.
constexpr double kMaxShownSpeed = 100.0;

Table DemandTable(const PathCheck& check) {
  Table table({"s", "x", "y", "curvature", "curvature_rate", "steering", "steering_rate",
               "lateral_acceleration", "speed", "speed_by_steering_rate", "speed_by_friction",
               "speed_by_rollover"});
  const auto shown = [](double speed) { return std::min(speed, kMaxShownSpeed); };
  for (const PathDemand& demand : check.demands) {
    table.AddRow({demand.s, demand.position.x(), demand.position.y(), demand.curvature,
                  demand.curvature_rate, demand.steering, demand.steering_rate,
                  demand.lateral_acceleration, shown(demand.speed),
                  shown(demand.speed_by_steering_rate), shown(demand.speed_by_friction),
                  shown(demand.speed_by_rollover)});
  }
  return table;
}

}  // namespace

ordered_json PathCheckJson(const PathCheckTitle& title, const FittedPath& fitted,
                           const PathCheck& check, const PathCheckOptions& options) {
  ordered_json faults = ordered_json::array();
  for (const PathFault& fault : check.faults) {
    faults.push_back({{"kind", ToString(fault.kind)},
                      {"s_m", fault.s},
                      {"from_s_m", fault.stations.from},
                      {"to_s_m", fault.stations.to},
                      {"x_m", fault.position.x()},
                      {"y_m", fault.position.y()},
                      {"asked", fault.required},
                      {"limit", fault.limit},
                      {"unit", UnitOf(fault.kind)},
                      {"text", ToString(fault)}});
  }
  ordered_json json{{"name", title.name},
                    {"vehicle", title.vehicle},
                    {"drivable", check.drivable()},
                    {"speed_mps", options.speed},
                    {"friction", options.friction},
                    {"max_speed_mps", OrNull(check.max_speed)},
                    {"max_speed_s_m", check.max_speed_station},
                    {"max_speed_limit", ToString(check.max_speed_limit)},
                    {"length_m", fitted.path.length()},
                    {"points", fitted.given.points.size()},
                    {"notes", title.notes},
                    {"fit", fitted.reversals.empty() ? Describe(fitted) : "none"},
                    {"deviation_m", fitted.deviation},
                    {"bulge_m", fitted.bulge},
                    {"steering_limit_rad", LimitJson(check.steering_limit)},
                    {"steering_rate_limit_radps", LimitJson(check.steering_rate_limit)},
                    {"friction_limit_mps2", LimitJson(check.friction_limit)},
                    {"rollover_limit_mps2", LimitJson(check.rollover_limit)}};
  json["faults"] = std::move(faults);
  json["version"] = Version();
  return json;
}

ordered_json PathCheckReport(const PathCheckTitle& title, const FittedPath& fitted,
                             const PathCheck& check, const PathCheckOptions& options) {
  ordered_json json = PathCheckJson(title, fitted, check, options);
  const Table table = DemandTable(check);
  const std::vector<std::size_t> rows = RowsToShow(table, kMaxDemands);
  ordered_json columns;
  for (const std::string& column : table.columns()) {
    columns[column] = RoundedColumn(table, column, rows);
  }
  json["demand"] = std::move(columns);
  // Adds a line through the given points to the map's data; the points are thinned evenly.
  const std::vector<Vec2>& points = fitted.given.points;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kMaxDemands);
  ordered_json xs = ordered_json::array();
  ordered_json ys = ordered_json::array();
  for (std::size_t i = 0; i < points.size(); i += step) {
    xs.push_back(Rounded(points[i].x()));
    ys.push_back(Rounded(points[i].y()));
  }
  json["given"] = {{"x", std::move(xs)}, {"y", std::move(ys)}};
  return {{"path_check", std::move(json)}};
}

}  // namespace trackbed
