#pragma once

#include <string_view>
#include <vector>

#include "trackbed/analysis/metric_registry.h"

namespace trackbed {

/// The metrics that Trackbed has itself, in the order of metrics.json.
std::vector<MetricEntry> OwnMetrics();

/// A metric of each turn that stands alone; in metrics.json under `turns[N]`.
struct TurnMetricEntry {
  const char* key;
  const char* label;
  const char* unit;
  MetricValue (*read)(const TurnMetrics& turn);
};

const std::vector<TurnMetricEntry>& TurnMetricTable();

/// A metric of each completed lap on a track; in metrics.json under `laps[N]`.
struct LapMetricEntry {
  const char* key;
  const char* label;
  const char* unit;
  MetricValue (*read)(const LapMetrics& lap);
};

const std::vector<LapMetricEntry>& LapMetricTable();

/// A metric of the predictions over one horizon; in metrics.json under `windows[N]`. Nothing where
/// there were no windows, or where a quantile is infinite.
struct WindowMetricEntry {
  const char* key;
  const char* label;
  const char* unit;
  MetricValue (*read)(const WindowErrors& errors);
};

const std::vector<WindowMetricEntry>& WindowMetricTable();

/// Puts a value into an entry of metrics.json, where its path says: "turns[0].waypoint" is
/// /turns/0/waypoint.
void PutMetric(const Metric& metric, nlohmann::ordered_json& json);

/// All that can be measured of the plant in a run of the scenario, with values that mean nothing.
PlantMetrics AllMetrics(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed
