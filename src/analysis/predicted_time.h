#pragma once

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Returns the run's duration as predicted by a speed profile at the car's limits [s]; nullopt for
/// other profiles.
inline std::optional<MetricReading> PredictedTime(const MetricInput& input) {
  const auto& profile = input.plan.diagnostics.speed_profile;
  return profile ? std::optional(MetricReading{profile->predicted_time, {}}) : std::nullopt;
}

/// Returns the ratio of the run's duration to the predicted duration; nullopt unless the car
/// arrived.
inline std::optional<MetricReading> TimeOverPredicted(const MetricInput& input) {
  const auto& profile = input.plan.diagnostics.speed_profile;
  if (!profile || input.log.status != DriveStatus::kArrived) {
    return std::nullopt;
  }
  return MetricReading{input.log.rows.back().state.time / profile->predicted_time, {}};
}

}  // namespace trackbed
