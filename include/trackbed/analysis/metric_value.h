#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>

/// The value of a metric and the part of the run that it refers to.
namespace trackbed {

/// Monostate: undefined, such as the recovery time of a car that never recovered; null in
/// metrics.json.
using MetricValue = std::variant<std::monostate, bool, int, double, std::string>;

/// The part of a run that a value refers to.
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
  double t = 0.0;       ///< time of the moment, or of the interval's end [s]
  double from_t = 0.0;  ///< [s]
};

/// A value and its place. The end of the run is filled in by the caller.
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

/// A limit that a standard sets for a quantity.
struct StandardLimit {
  enum class Relation { kAtMost, kAtLeast };
  Relation relation = Relation::kAtMost;
  double bound = 0.0;  ///< in the quantity's unit

  [[nodiscard]] bool Met(double value) const {
    return relation == Relation::kAtMost ? value <= bound : value >= bound;
  }
};

/// Label and unit of a metric.
struct MetricInfo {
  std::string label;      ///< "Maximum cross-track error"
  std::string unit;       ///< SI, "m/s^2"; empty for ratios, counts and texts
  bool headline = false;  ///< shown first in a report
  std::optional<StandardLimit> limit = std::nullopt;  ///< of a standard maneuver
};

nlohmann::ordered_json ToJson(const MetricValue& value);

/// Text for the table of a study: numbers with the shortest round-trip digits, texts unchanged.
std::string ToText(const MetricValue& value);

}  // namespace trackbed
