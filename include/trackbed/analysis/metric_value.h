#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>

/// The value of a metric and the part of the run that it refers to.
namespace trackbed {

/// The value of a metric. Monostate means that the value is undefined, such as the recovery time of
/// a car that never recovered; metrics.json then contains null.
using MetricValue = std::variant<std::monostate, bool, int, double, std::string>;

/// The part of a run that a value refers to.
enum class MetricSpan {
  kRun,       ///< The whole run.
  kEnd,       ///< The end of the run.
  kMoment,    ///< One moment, such as the time of the largest value.
  kSince,     ///< The part of the run from `from_t` on.
  kInterval,  ///< The interval from `from_t` to `t`.
};

struct MetricPlace {
  MetricSpan span = MetricSpan::kRun;
  /// Station of the moment [m]; with kRun, kEnd and kSince, the station of the run's end.
  double s = 0.0;
  double t = 0.0;       ///< Time of the moment, or of the interval's end [s].
  double from_t = 0.0;  ///< Start of the part of the run, for kSince and kInterval [s].
};

/// A value with the place where it was measured. If the place includes the end of the run, the
/// caller fills in the station and time of the end.
struct MetricReading {
  MetricValue value;
  MetricPlace at;
};

/// One value of a plant's entry in metrics.json.
struct Metric {
  std::string path;  ///< Path, such as "cross_track.max", "turns[0].lateral_offset".
  MetricValue value;
  MetricPlace at;
};

/// A limit that a standard sets for a quantity.
struct StandardLimit {
  enum class Relation { kAtMost, kAtLeast };
  Relation relation = Relation::kAtMost;
  double bound = 0.0;  ///< Bound in the unit of the quantity.

  [[nodiscard]] bool Met(double value) const {
    return relation == Relation::kAtMost ? value <= bound : value >= bound;
  }
};

/// Label and unit of a metric.
struct MetricInfo {
  std::string label;      ///< Label such as "Maximum cross-track error".
  std::string unit;       ///< SI unit, "m/s^2"; empty for ratios, counts and texts.
  bool headline = false;  ///< Whether reports show the metric first.
  /// Limit that a standard sets for the maneuver.
  std::optional<StandardLimit> limit = std::nullopt;
};

nlohmann::ordered_json ToJson(const MetricValue& value);

/// Formats a value for a study's table: numbers with the shortest round-trip digits, texts
/// unchanged.
std::string ToText(const MetricValue& value);

}  // namespace trackbed
