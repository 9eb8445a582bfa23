#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/analysis/metrics.h"

/// The table of all metrics, which defines their paths, labels and units for metrics.json,
/// `expect.metrics`, messages, study outputs and reports. The metrics of maneuvers are listed in
/// trackbed/analysis/maneuver_metrics.h. The metrics of comparisons are listed in
/// ComparedQuantities().
namespace trackbed {

/// The data from which a metric is measured: one plant's run, the initial plan of the run, and the
/// car.
struct MetricInput {
  const RunLog& log;  ///< Log of the run, with at least one row.
  const Plan& plan;
  const VehicleParams& vehicle;
};

/// A metric that is measured for every plant of a run. Exactly one of `read` and `measure` is set.
/// If a run has no value of the metric, `read` or `measure` returns nullopt, and metrics.json lacks
/// the metric's key.
struct MetricEntry {
  /// Path of the metric in metrics.json: words of a-z, 0-9 and '_', joined by '.'.
  std::string path;
  std::string label;  ///< Label of the metric in a report, such as "Maximum cross-track error".
  std::string unit;   ///< SI unit of the metric, such as "m/s^2"; empty for dimensionless values.
  std::function<std::optional<MetricReading>(const PlantMetrics&)> read = {};
  std::function<std::optional<MetricReading>(const MetricInput&)> measure = {};
  bool headline = false;  ///< Whether reports show the metric among the most important ones.
  /// Whether the metric's value belongs to one moment of the run (MetricSpan::kMoment). If
  /// `located` is true, metrics.json also has the keys PATH_s (station of the moment [m]) and
  /// PATH_t (time of the moment [s]).
  bool located = false;
};

/// Returns all metrics, in the order of metrics.json.
const std::vector<MetricEntry>& Metrics();

/// Adds a user-defined metric to metrics.json, `expect.metrics`, studies and reports.
/// RegisterMetric must be called before any run and from one thread, such as at the start of main.
/// Throws InputError if the path is malformed or taken, if the label is empty, or if `read` and
/// `measure` are both set or both missing.
void RegisterMetric(MetricEntry entry);

/// Returns every value of a plant's entry in metrics.json, in the order of the file.
std::vector<Metric> ListMetrics(const PlantMetrics& metrics);

/// Returns every value of an entry in the section `between` of metrics.json, except the plants'
/// names.
std::vector<Metric> ListMetrics(const PlantComparison& comparison);

/// Returns the label and unit of a metric by its path in a plant's entry of metrics.json; nullopt
/// for an unknown path.
std::optional<MetricInfo> DescribeMetric(std::string_view path);

/// Returns the label and unit of a metric in the section `between` of metrics.json by its path,
/// such as "position.max"; nullopt for an unknown path.
std::optional<MetricInfo> DescribeComparisonMetric(std::string_view path);

}  // namespace trackbed
