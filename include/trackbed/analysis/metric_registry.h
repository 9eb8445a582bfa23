#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/analysis/metrics.h"

/// The table of metrics: what metrics.json, `expect.metrics`, messages, the outputs of studies and
/// reports know of a metric comes from here. The metrics of a manoeuvre are listed where it is
/// evaluated (trackbed/analysis/manoeuvre.h), those of a comparison in ComparedQuantities().
namespace trackbed {

/// What a metric is measured on: one plant's run, the plan that it began with, and the car.
struct MetricInput {
  const RunLog& log;  ///< has at least one row
  const Plan& plan;
  const VehicleParams& vehicle;
};

/// A metric of every plant's run. One of `read` and `measure` is given; either returns nothing
/// where the run has no such value, and then metrics.json has no such key.
struct MetricEntry {
  std::string path;   ///< in metrics.json: words of a-z, 0-9 and '_', sections joined by '.'
  std::string label;  ///< on a report: "Maximum cross-track error"
  std::string unit;   ///< SI, "m/s^2"; empty for what has none
  std::function<std::optional<MetricReading>(const PlantMetrics&)> read = {};
  std::function<std::optional<MetricReading>(const MetricInput&)> measure = {};
  bool headline = false;  ///< shown first in a report
  /// The value is of one moment (MetricSpan::kMoment), which metrics.json has as PATH_s [m] and
  /// PATH_t [s].
  bool located = false;
};

/// All metrics, in the order of metrics.json.
const std::vector<MetricEntry>& Metrics();

/// Adds a metric of your own to metrics.json, `expect.metrics`, studies and reports. To be called
/// before any run and by one thread, such as at the beginning of main. InputError when the path is
/// malformed or taken, there is no label, or not exactly one of `read` and `measure`.
void RegisterMetric(MetricEntry entry);

/// Every value of a plant's entry in metrics.json, in its order.
std::vector<Metric> ListMetrics(const PlantMetrics& metrics);

/// Every value of an entry of `between`, but for the plants' names.
std::vector<Metric> ListMetrics(const PlantComparison& comparison);

/// What a path in a plant's entry is called; nothing for a path that is in no table.
std::optional<MetricInfo> DescribeMetric(std::string_view path);

/// The same of an entry of `between`: "position.max".
std::optional<MetricInfo> DescribeComparisonMetric(std::string_view path);

}  // namespace trackbed
