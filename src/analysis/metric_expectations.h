#pragma once

#include <string>
#include <vector>

#include "trackbed/analysis/metrics.h"

namespace trackbed {

/// Adds to the verdict's failures what a plant's entry in metrics.json does not keep.
void JudgeMetrics(const std::vector<MetricExpectation>& expectations, const PlantMetrics& metrics,
                  Verdict& verdict);

/// " over the drive to s = 20 m, t = 8 s": the span of what has no place of its own.
std::string OverTheDrive(const PlantMetrics& metrics);

/// All that can be measured of the plant in a run of the scenario, with values that mean nothing.
PlantMetrics EveryMetricOf(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed
