#pragma once

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Duration predicted by the speed profile at the limit [s]; none for other profiles.
inline std::optional<MetricReading> PredictedTime(const MetricInput& input) {
  const auto& profile = input.plan.diagnostics.speed_profile;
  return profile ? std::optional(MetricReading{profile->predicted_time, {}}) : std::nullopt;
}

/// Duration of the run relative to the predicted duration; none unless the car arrived.
inline std::optional<MetricReading> TimeOverPredicted(const MetricInput& input) {
  const auto& profile = input.plan.diagnostics.speed_profile;
  if (!profile || input.log.status != DriveStatus::kArrived) {
    return std::nullopt;
  }
  return MetricReading{input.log.rows.back().state.time / profile->predicted_time, {}};
}

}  // namespace trackbed
