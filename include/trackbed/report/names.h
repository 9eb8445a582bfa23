#pragma once

#include <optional>
#include <string>

#include "trackbed/analysis/metric_value.h"

/// Labels and units of the values in metrics.json and in the table of a sweep.
namespace trackbed {

struct ShownName {
  std::string label;
  std::string unit;  ///< Unit of the value; empty if the value is dimensionless.
  /// Whether the value is a headline, which reports show before all other values.
  bool headline = false;
  /// Limit that the maneuver's standard sets for the value.
  std::optional<StandardLimit> limit = std::nullopt;
};

/// Returns the label and unit of a metric. The argument `path` is the path of the metric in a
/// plant's entry of metrics.json, such as "cross_track.max" or "turns[0].lateral_offset". If no
/// label is registered for the path, the label is the path.
ShownName NameOfMetric(const std::string& path);

/// Returns the label and unit of a difference between plants. The argument `path` is the path of
/// the difference in an entry of `between` in metrics.json, such as "position.max".
ShownName NameOfComparison(const std::string& path);

/// Returns the label and unit of an output of a study; `path` is the path of the output, such as
/// "metrics.mujoco.cross_track.max".
ShownName NameOfOutput(const std::string& path);

/// Returns the label and unit of a scenario key; the label is the key itself.
ShownName NameOfKey(const std::string& key);

}  // namespace trackbed
