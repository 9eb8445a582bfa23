#include "trackbed/analysis/maneuver_metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "src/analysis/evaluations.h"
#include "src/analysis/peaks.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

/// Lists the metrics that every maneuver has.
const std::vector<ManeuverMetric>& CommonMetrics() {
  static const std::vector<ManeuverMetric> metrics{
      {"method", "method", ""},
      {"passed", "passed", "", true},
      {"begin", "evaluated from", "s"},
      {"end", "evaluated until", "s"},
      {"steering_saturated_fraction", "fraction of time at a steering limit", ""},
      {"missing", "not measured", ""}};
  return metrics;
}

std::vector<ManeuverMetric> ListMethodMetrics(const ManeuverOptions& options) {
  return std::visit([](const auto& own) { return MethodMetrics(own); }, options);
}

/// Marks the maneuver as failed if the car tips over.
void CheckRoll(const RunLog& log, ManeuverMetrics& metrics) {
  constexpr double kTippedOver = 0.25 * kPi;  // roll angle from which a car cannot recover [rad]
  const auto tipped = std::find_if(log.rows.begin(), log.rows.end(), [](const LogRow& row) {
    return std::abs(row.state.roll) > kTippedOver;
  });
  const bool rolled_over = log.status == DriveStatus::kRolledOver;
  if (rolled_over || tipped != log.rows.end()) {
    metrics.passed = false;
    metrics.missing += metrics.missing.empty() ? "" : "; ";
    metrics.missing +=
        rolled_over ? fmt::format("the car rolls over at {:.2f} s", log.rows.back().state.time)
                    : fmt::format("the car leans by 45 degrees at {:.2f} s", tipped->state.time);
  }
}

}  // namespace

std::optional<double> ManeuverMetrics::Find(std::string_view name) const {
  for (const auto& [own, value] : values) {
    if (own == name) {
      return value;
    }
  }
  return std::nullopt;
}

ManeuverMetrics EvaluateManeuver(const ManeuverOptions& options, const RunLog& log,
                                 const Plan& plan, const VehicleParams& vehicle) {
  TRACKBED_CHECK(!log.rows.empty(), "the log of {} is empty", log.plant);
  ManeuverMetrics metrics;
  metrics.method = ManeuverName(options);
  metrics.begin = log.rows.front().state.time;
  metrics.end = log.rows.back().state.time;
  const ManeuverInput input{log, plan, vehicle};
  std::visit([&](const auto& own) { Evaluate(own, input, metrics); }, options);
  for (const auto& [name, value] : metrics.values) {
    TRACKBED_CHECK(AllMetrics(options).Find(name), "a value that is not in the list: {}", name);
  }
  CheckRoll(log, metrics);
  metrics.steering_saturated_fraction = SaturatedFraction(log, vehicle, metrics.begin, metrics.end);
  return metrics;
}

ManeuverMetrics AllMetrics(const ManeuverOptions& options) {
  ManeuverMetrics metrics;
  metrics.method = ManeuverName(options);
  metrics.passed = false;
  metrics.missing = "why";
  for (const ManeuverMetric& own : ListMethodMetrics(options)) {
    metrics.values.emplace_back(own.name, 0.0);
  }
  return metrics;
}

std::vector<Metric> ListMetrics(const ManeuverMetrics& metrics) {
  std::vector<Metric> all;
  const auto add = [&](const std::string& name, MetricValue value) {
    all.push_back({name,
                   std::move(value),
                   {.span = MetricSpan::kInterval, .t = metrics.end, .from_t = metrics.begin}});
  };
  add("method", metrics.method);
  if (metrics.passed) {
    add("passed", *metrics.passed);
  }
  for (const auto& [name, value] : metrics.values) {
    add(name, value);
  }
  add("begin", metrics.begin);
  add("end", metrics.end);
  add("steering_saturated_fraction", metrics.steering_saturated_fraction);
  if (!metrics.missing.empty()) {
    add("missing", metrics.missing);
  }
  return all;
}

std::optional<MetricInfo> DescribeManeuverMetric(std::string_view name) {
  const auto find = [&](const std::vector<ManeuverMetric>& metrics) -> std::optional<MetricInfo> {
    for (const ManeuverMetric& metric : metrics) {
      if (name == metric.name) {
        return MetricInfo{metric.label, metric.unit, metric.headline, metric.limit};
      }
    }
    return std::nullopt;
  };
  std::optional<MetricInfo> info = find(CommonMetrics());
  for (const ManeuverEntry& maneuver : Maneuvers()) {
    info = info ? info : find(ListMethodMetrics(maneuver.defaults));
  }
  return info;
}

}  // namespace trackbed
