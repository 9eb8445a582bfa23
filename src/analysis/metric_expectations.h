#pragma once

#include <vector>

#include "trackbed/analysis/metrics.h"

namespace trackbed {

/// Adds to the verdict's failures what a plant's entry in metrics.json does not keep.
void JudgeMetrics(const std::vector<MetricExpectation>& expectations, const PlantMetrics& metrics,
                  Verdict& verdict);

}  // namespace trackbed
