#pragma once

#include <optional>
#include <string>

#include "trackbed/analysis/metric_value.h"

/// What people call the numbers of metrics.json and of a sweep's table.
namespace trackbed {

struct ShownName {
  std::string label;
  std::string unit;                                   ///< empty for what is no quantity
  bool headline = false;                              ///< whether it belongs to what is read first
  std::optional<StandardLimit> limit = std::nullopt;  ///< of a standard maneuver
};

/// Of a path in a plant's entry of metrics.json, such as "cross_track.max" or
/// "turns[0].lateral_offset". Paths without a name of their own are their own label.
ShownName NameOfMetric(const std::string& path);

/// Of a path in an entry of `between`, such as "position.max".
ShownName NameOfComparison(const std::string& path);

/// Of an output of a study: "metrics.mujoco.cross_track.max".
ShownName NameOfOutput(const std::string& path);

/// Of a key of a scenario, which is its own label.
ShownName NameOfKey(const std::string& key);

}  // namespace trackbed
