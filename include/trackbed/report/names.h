#pragma once

#include <optional>
#include <string>

#include "trackbed/analysis/metric_value.h"

/// Labels and units of the values in metrics.json and in a sweep's table.
namespace trackbed {

struct ShownName {
  std::string label;
  std::string unit;                                   ///< empty for dimensionless values
  bool headline = false;                              ///< shown first in a report
  std::optional<StandardLimit> limit = std::nullopt;  ///< of a standard maneuver
};

/// The name of a path in a plant's entry of metrics.json, such as "cross_track.max" or
/// "turns[0].lateral_offset". A path without a registered name is its label.
ShownName NameOfMetric(const std::string& path);

/// The name of a path in an entry of `between`, such as "position.max".
ShownName NameOfComparison(const std::string& path);

/// The name of an output of a study: "metrics.mujoco.cross_track.max".
ShownName NameOfOutput(const std::string& path);

/// The name of a key of a scenario; its label is the key itself.
ShownName NameOfKey(const std::string& key);

}  // namespace trackbed
