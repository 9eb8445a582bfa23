#pragma once

#include <cmath>

#include "src/analysis/peaks.h"
#include "trackbed/analysis/metric_registry.h"

namespace trackbed {

/// Returns the largest magnitude of the sideslip angle at the center of gravity [rad], up to the
/// first contact with an obstacle. Only rows with speeds above 1 m/s count, because the sway of the
/// body on its suspension dominates the sideslip at lower speeds. The largest sideslip is 0 for a
/// car that never exceeds 1 m/s.
inline std::optional<MetricReading> LargestSideslip(const MetricInput& input) {
  constexpr double kMinSpeed = 1.0;  // [m/s]
  double largest = 0.0;
  MetricPlace at{.span = MetricSpan::kMoment};
  for (const LogRow& row : input.log.rows) {
    if (input.log.contact_time && row.state.time > *input.log.contact_time) {
      break;
    }
    const double sideslip = std::abs(row.state.sideslip);
    if (std::hypot(row.state.speed, row.state.lateral_speed) >= kMinSpeed && sideslip > largest) {
      largest = sideslip;
      at.s = RowStation(row);
      at.t = row.state.time;
    }
  }
  return MetricReading{largest, at};
}

}  // namespace trackbed
