#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/analysis/metrics.h"

/// The table of metrics: the single source of paths, labels and units for metrics.json,
/// `expect.metrics`, messages, study outputs and reports. The metrics of maneuvers are listed in
/// trackbed/analysis/maneuver_metrics.h, the metrics of comparisons in ComparedQuantities().
namespace trackbed {

/// The input of a metric: one plant's run, its initial plan and the car.
struct MetricInput {
  const RunLog& log;  ///< Log of the run, with at least one row.
  const Plan& plan;
  const VehicleParams& vehicle;
};

/// A metric of every plant's run. Exactly one of `read` and `measure` is set. If a run has no value
/// of the metric, `read` or `measure` returns nullopt, and metrics.json lacks the metric's key.
struct MetricEntry {
  std::string path;   ///< Path in metrics.json: words of a-z, 0-9 and '_', sections joined by '.'.
  std::string label;  ///< Label in a report: "Maximum cross-track error".
  std::string unit;   ///< SI unit, "m/s^2"; empty for dimensionless values.
  std::function<std::optional<MetricReading>(const PlantMetrics&)> read = {};
  std::function<std::optional<MetricReading>(const MetricInput&)> measure = {};
  bool headline = false;  ///< Whether reports show the metric first.
  /// Whether the value belongs to one moment (MetricSpan::kMoment). If `located` is true,
  /// metrics.json also has the station, PATH_s [m], and the time, PATH_t [s].
  bool located = false;
};

/// Returns all metrics, in the order of metrics.json.
const std::vector<MetricEntry>& Metrics();

/// Adds a user-defined metric to metrics.json, `expect.metrics`, studies and reports. Call
/// RegisterMetric before any run, from one thread, such as at the start of main. InputError if the
/// path is malformed or taken, if the label is empty, or if `read` and `measure` are both set or
/// both missing.
void RegisterMetric(MetricEntry entry);

/// Lists every value of a plant's entry in metrics.json, in file order.
std::vector<Metric> ListMetrics(const PlantMetrics& metrics);

/// Lists every value of an entry of `between` in metrics.json, except the plants' names.
std::vector<Metric> ListMetrics(const PlantComparison& comparison);

/// Returns the label and unit of the metric at a path in a plant's entry of metrics.json; nullopt
/// for an unknown path.
std::optional<MetricInfo> DescribeMetric(std::string_view path);

/// Returns the label and unit of the metric at a path in an entry of `between`, such as
/// "position.max"; nullopt for an unknown path.
std::optional<MetricInfo> DescribeComparisonMetric(std::string_view path);

}  // namespace trackbed
