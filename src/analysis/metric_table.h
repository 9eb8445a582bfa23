#pragma once

#include <string_view>
#include <vector>

#include "trackbed/analysis/metric_registry.h"

namespace trackbed {

/// Returns the metrics that Trackbed defines, in the order of metrics.json.
std::vector<MetricEntry> BuiltInMetrics();

/// A metric of each isolated turn, written to metrics.json under `turns[N]`.
struct TurnMetricEntry {
  const char* key;
  const char* label;
  const char* unit;
  MetricValue (*read)(const TurnMetrics& turn);
};

const std::vector<TurnMetricEntry>& TurnMetricTable();

/// A metric of each completed lap, written to metrics.json under `laps[N]`.
struct LapMetricEntry {
  const char* key;
  const char* label;
  const char* unit;
  MetricValue (*read)(const LapMetrics& lap);
};

const std::vector<LapMetricEntry>& LapMetricTable();

/// A metric of the predictions over one horizon, written to metrics.json under `windows[N]`. The
/// metric is null if there were no prediction windows, or if a quantile is infinite.
struct WindowMetricEntry {
  const char* key;
  const char* label;
  const char* unit;
  MetricValue (*read)(const WindowErrors& errors);
};

const std::vector<WindowMetricEntry>& WindowMetricTable();

/// Writes the value of a metric into `json` at the path of the metric: "turns[0].waypoint" becomes
/// /turns/0/waypoint.
void PutMetric(const Metric& metric, nlohmann::ordered_json& json);

/// Returns all metrics that a run of the plant can have in the scenario, filled with dummy values.
PlantMetrics AllMetrics(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed
