#pragma once

#include <string>
#include <vector>

#include "trackbed/analysis/metrics.h"

/// Requirements of `expect`, evaluated on the log of a plant (trackbed/requirement/formula.h).
namespace trackbed {

/// Evaluates a formula over the whole log, whose columns are its signals. Never throws: errors in
/// the formula or the log are reported in RequirementMetrics::problem.
RequirementMetrics MeasureRequirement(const RequirementExpectation& requirement, const RunLog& log);

/// Evaluates the requirements on all plants, then the requirements on the plant of the log.
std::vector<RequirementMetrics> MeasureRequirements(const Expectations& expect, const RunLog& log);

/// The path of the robustness in the plant's entry in metrics.json: "requirements.NAME.robustness".
std::string RequirementPath(const std::string& name);

}  // namespace trackbed
