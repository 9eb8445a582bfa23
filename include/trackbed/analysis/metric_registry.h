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
/// `expect.metrics`, messages, study outputs and reports. The metrics of a maneuver are listed
/// where it is evaluated (trackbed/analysis/maneuver_metrics.h), those of a comparison in
/// ComparedQuantities().
namespace trackbed {

/// The input of a metric: one plant's run, its initial plan and the car.
struct MetricInput {
  const RunLog& log;  ///< has at least one row
  const Plan& plan;
  const VehicleParams& vehicle;
};

/// A metric of every plant's run. Exactly one of `read` and `measure` is set; it returns nothing if
/// the run has no such value, and metrics.json then lacks the key.
struct MetricEntry {
  std::string path;   ///< in metrics.json: words of a-z, 0-9 and '_', sections joined by '.'
  std::string label;  ///< on a report: "Maximum cross-track error"
  std::string unit;   ///< SI, "m/s^2"; empty for dimensionless values
  std::function<std::optional<MetricReading>(const PlantMetrics&)> read = {};
  std::function<std::optional<MetricReading>(const MetricInput&)> measure = {};
  bool headline = false;  ///< shown first in a report
  /// The value belongs to one moment (MetricSpan::kMoment), stored in metrics.json as PATH_s [m]
  /// and PATH_t [s].
  bool located = false;
};

/// All metrics, in the order of metrics.json.
const std::vector<MetricEntry>& Metrics();

/// Adds a user-defined metric to metrics.json, `expect.metrics`, studies and reports. Call it
/// before any run, from one thread, such as at the start of main. InputError when the path is
/// malformed or taken, the label is empty, or not exactly one of `read` and `measure` is set.
void RegisterMetric(MetricEntry entry);

/// Every value of a plant's entry in metrics.json, in its order.
std::vector<Metric> ListMetrics(const PlantMetrics& metrics);

/// Every value of an entry of `between`, except the plants' names.
std::vector<Metric> ListMetrics(const PlantComparison& comparison);

/// Label and unit of a path in a plant's entry; nullopt for an unknown path.
std::optional<MetricInfo> DescribeMetric(std::string_view path);

/// Label and unit of a path in an entry of `between`, such as "position.max"; nullopt if unknown.
std::optional<MetricInfo> DescribeComparisonMetric(std::string_view path);

}  // namespace trackbed
