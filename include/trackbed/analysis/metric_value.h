#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>

/// What one metric of a run was, and over which part of the run.
namespace trackbed {

/// Monostate: looked for and not found, such as the recovery of a car that never recovered; null in
/// metrics.json.
using MetricValue = std::variant<std::monostate, bool, int, double, std::string>;

/// The part of a run that a value is of.
enum class MetricSpan {
  kRun,       ///< all of it
  kEnd,       ///< its end
  kMoment,    ///< one moment, such as that of a largest value
  kSince,     ///< from `from_t` on
  kInterval,  ///< from `from_t` to `t`
};

struct MetricPlace {
  MetricSpan span = MetricSpan::kRun;
  double s = 0.0;       ///< station of the moment; with kRun, kEnd and kSince, of the run's end [m]
  double t = 0.0;       ///< time of the moment, or of the end of the part [s]
  double from_t = 0.0;  ///< [s]
};

/// A value and where it was. The run fills in the place of its own end.
struct MetricReading {
  MetricValue value;
  MetricPlace at;
};

/// One value of a plant's entry in metrics.json.
struct Metric {
  std::string path;  ///< "cross_track.max", "turns[0].lateral_offset"
  MetricValue value;
  MetricPlace at;
};

/// What people call a metric.
struct MetricInfo {
  std::string label;      ///< "Maximum cross-track error"
  std::string unit;       ///< SI, "m/s^2"; empty for ratios, counts and texts
  bool headline = false;  ///< shown first in a report
};

nlohmann::ordered_json ToJson(const MetricValue& value);

/// As it stands in the table of a study: numbers with the digits that they need, texts as they are.
std::string ToText(const MetricValue& value);

}  // namespace trackbed
