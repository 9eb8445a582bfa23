#pragma once

#include <optional>

#include "trackbed/analysis/metric_registry.h"

/// Measures the motion of a trailer (TrailerState). All trailer metrics are nullopt for a car
/// without trailer.
namespace trackbed {

/// Returns the largest magnitude of the hitch angle [rad].
std::optional<MetricReading> LargestHitchAngle(const MetricInput& input);

/// Returns the largest magnitude of the rate of the hitch angle [rad/s].
std::optional<MetricReading> LargestHitchRate(const MetricInput& input);

/// Returns the largest distance [m] of the middle of the trailer's axle from the line that the
/// middle of the car's rear axle has driven so far. For the off-tracking, the driven line of the
/// car is extended straight back from the start of the run.
std::optional<MetricReading> LargestOffTracking(const MetricInput& input);

}  // namespace trackbed
