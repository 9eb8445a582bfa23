#pragma once

#include <optional>
#include <string>

#include "trackbed/analysis/metric_value.h"

/// Labels and units of the values in metrics.json and in a sweep's table.
namespace trackbed {

struct ShownName {
  std::string label;
  std::string unit;       ///< Unit; empty for dimensionless values.
  bool headline = false;  ///< Whether reports show the value first.
  /// Limit that a standard sets for the maneuver.
  std::optional<StandardLimit> limit = std::nullopt;
};

/// The name of a path in a plant's entry of metrics.json, such as "cross_track.max" or
/// "turns[0].lateral_offset". If a path has no registered name, the label is the path.
ShownName NameOfMetric(const std::string& path);

/// The name of a path in an entry of `between`, such as "position.max".
ShownName NameOfComparison(const std::string& path);

/// The name of an output of a study: "metrics.mujoco.cross_track.max".
ShownName NameOfOutput(const std::string& path);

/// The name of a key of a scenario. The label is the key.
ShownName NameOfKey(const std::string& key);

}  // namespace trackbed
