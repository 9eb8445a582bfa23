#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/scenario/scenario.h"

/// Measures the interventions of the driver aids (AidState).
namespace trackbed {

/// Returns the time for which anti-lock control limits the brake torque of a wheel [s]; nullopt if
/// the car has no anti-lock brakes.
std::optional<MetricReading> TimeOfAbs(const MetricInput& input);

/// Returns the time for which stability control brakes a wheel [s]; nullopt if the car has no
/// stability control.
std::optional<MetricReading> TimeOfEsc(const MetricInput& input);

/// Returns the largest brake torque that stability control applies to a wheel [N m]; nullopt if the
/// car has no stability control.
std::optional<MetricReading> LargestEscTorque(const MetricInput& input);

/// Appends a note to `notes` for each plant that ignores the driver aids of the scenario.
void NoteIgnoredAids(const Scenario& scenario, const std::vector<RunLog>& logs,
                     std::vector<std::string>& notes);

}  // namespace trackbed
