#pragma once

#include <optional>
#include <string>

#include "trackbed/analysis/metric_value.h"

/// Labels and units of the values in metrics.json and in the table of a sweep.
namespace trackbed {

struct ShownName {
  std::string label;
  std::string unit;       ///< Unit; empty for dimensionless values.
  bool headline = false;  ///< Whether the value is one of those that reports show first.
  /// Limit that a standard sets for the maneuver.
  std::optional<StandardLimit> limit = std::nullopt;
};

/// Returns the name of a metric, given by its path in a plant's entry of metrics.json, such as
/// "cross_track.max" or "turns[0].lateral_offset". If no name is registered for the path, the label
/// is the path.
ShownName NameOfMetric(const std::string& path);

/// Returns the name of a difference between plants, given by its path in an entry of `between` in
/// metrics.json, such as "position.max".
ShownName NameOfComparison(const std::string& path);

/// Returns the name of an output of a study, given by its path, such as
/// "metrics.mujoco.cross_track.max".
ShownName NameOfOutput(const std::string& path);

/// Returns the name of a scenario key, whose label is the key itself.
ShownName NameOfKey(const std::string& key);

}  // namespace trackbed
