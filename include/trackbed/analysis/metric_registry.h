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

/// A metric of every plant's run. Exactly one of `read` and `measure` is set. The function returns
/// nothing if the run has no such value; metrics.json then lacks the key.
struct MetricEntry {
  std::string path;   ///< Path in metrics.json: words of a-z, 0-9 and '_', sections joined by '.'.
  std::string label;  ///< Label in a report: "Maximum cross-track error".
  std::string unit;   ///< SI unit, "m/s^2"; empty for dimensionless values.
  std::function<std::optional<MetricReading>(const PlantMetrics&)> read = {};
  std::function<std::optional<MetricReading>(const MetricInput&)> measure = {};
  bool headline = false;  ///< Whether reports show the metric first.
  /// Whether the value belongs to one moment (MetricSpan::kMoment). The file metrics.json then has
  /// the station PATH_s [m] and the time PATH_t [s].
  bool located = false;
};

/// Returns all metrics, in the order of metrics.json.
const std::vector<MetricEntry>& Metrics();

/// Adds a user-defined metric to metrics.json, `expect.metrics`, studies and reports. Call it
/// before any run, from one thread, such as at the start of main. InputError if the path is
/// malformed or taken, or if the label is empty. Also InputError unless exactly one of `read` and
/// `measure` is set.
void RegisterMetric(MetricEntry entry);

/// Lists every value of a plant's entry in metrics.json, in file order.
std::vector<Metric> ListMetrics(const PlantMetrics& metrics);

/// Lists every value of an entry of `between`, except the plants' names.
std::vector<Metric> ListMetrics(const PlantComparison& comparison);

/// Returns label and unit of a path in a plant's entry; nullopt for an unknown path.
std::optional<MetricInfo> DescribeMetric(std::string_view path);

/// Returns label and unit of a path in an entry of `between`, such as "position.max"; nullopt if
/// unknown.
std::optional<MetricInfo> DescribeComparisonMetric(std::string_view path);

}  // namespace trackbed
