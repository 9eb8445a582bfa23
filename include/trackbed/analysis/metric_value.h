#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>

/// Metric values, each with the part of the run in which the value was measured.
namespace trackbed {

/// The value of a metric. The alternative std::monostate means that the value is undefined, such as
/// the recovery time of a car that never recovered. An undefined value is written to metrics.json
/// as null.
using MetricValue = std::variant<std::monostate, bool, int, double, std::string>;

/// The part of a run to which the value of a metric refers.
enum class MetricSpan {
  kRun,       ///< The whole run.
  kEnd,       ///< The value refers to the end of the run.
  kMoment,    ///< The value refers to one moment, such as the time of the largest error.
  kSince,     ///< The value refers to the part of the run from the time `from_t` on.
  kInterval,  ///< The value refers to the interval from `from_t` to `t`.
};

struct MetricPlace {
  MetricSpan span = MetricSpan::kRun;
  /// Station of the car [m] at the moment of the value; for kRun, kEnd and kSince, at the end of
  /// the run.
  double s = 0.0;
  double t = 0.0;  ///< Time of the value's moment, or of the end of the value's interval [s].
  /// Start of the part of the run to which the value refers, for kSince and kInterval [s].
  double from_t = 0.0;
};

/// The value of a metric, with the part of the run to which the value refers. If the part of the
/// run ends at the end of the run, the caller fills in the station and time of the end.
struct MetricReading {
  MetricValue value;
  MetricPlace at;
};

/// One value of a plant's entry in metrics.json.
struct Metric {
  /// Path of the metric, such as "cross_track.max" or "turns[0].lateral_offset".
  std::string path;
  MetricValue value;
  MetricPlace at;
};

/// A limit that a standard sets for a quantity.
struct StandardLimit {
  enum class Relation { kAtMost, kAtLeast };
  Relation relation = Relation::kAtMost;
  double bound = 0.0;  ///< Bound on the quantity, in the quantity's unit.

  [[nodiscard]] bool Met(double value) const {
    return relation == Relation::kAtMost ? value <= bound : value >= bound;
  }
};

/// Label and unit of a metric.
struct MetricInfo {
  std::string label;  ///< Label of the metric, such as "Maximum cross-track error".
  /// SI unit of the metric, such as "m/s^2"; empty for ratios, counts and texts.
  std::string unit;
  bool headline = false;  ///< Whether reports show the metric among the most important ones.
  /// Limit on the metric that a standard sets for the maneuver.
  std::optional<StandardLimit> limit = std::nullopt;
};

nlohmann::ordered_json ToJson(const MetricValue& value);

/// Formats the value of a metric for a study's table. Numbers get the fewest digits that can be
/// read back exactly; texts are unchanged.
std::string ToText(const MetricValue& value);

}  // namespace trackbed
