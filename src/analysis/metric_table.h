#pragma once

#include <string_view>
#include <vector>

#include "trackbed/analysis/metric_registry.h"

namespace trackbed {

/// Returns the metrics that Trackbed defines, in the order of metrics.json.
std::vector<MetricEntry> BuiltInMetrics();

/// Describes a metric of isolated turns, which metrics.json contains for each turn under
/// `turns[N]`.
struct TurnMetricEntry {
  const char* key;
  const char* label;
  const char* unit;
  MetricValue (*read)(const TurnMetrics& turn);
};

const std::vector<TurnMetricEntry>& TurnMetricTable();

/// Describes a metric of completed laps, which metrics.json contains for each lap under `laps[N]`.
struct LapMetricEntry {
  const char* key;
  const char* label;
  const char* unit;
  MetricValue (*read)(const LapMetrics& lap);
};

const std::vector<LapMetricEntry>& LapMetricTable();

/// Describes a metric of the predictions over one horizon, which metrics.json contains for each
/// horizon under `windows[N]`. The value of a prediction metric in metrics.json is null if the run
/// had no prediction windows, or if a quantile is infinite.
struct WindowMetricEntry {
  const char* key;
  const char* label;
  const char* unit;
  MetricValue (*read)(const WindowErrors& errors);
};

const std::vector<WindowMetricEntry>& WindowMetricTable();

/// Writes the value of a metric into `json` at the metric's path; for example, the path
/// "turns[0].waypoint" is the JSON pointer /turns/0/waypoint.
void PutMetric(const Metric& metric, nlohmann::ordered_json& json);

/// Returns all metrics that a run of the scenario can have for the plant, with dummy values.
PlantMetrics AllMetrics(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed
