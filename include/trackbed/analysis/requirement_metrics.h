#pragma once

#include <string>
#include <vector>

#include "trackbed/analysis/metrics.h"

/// Evaluates the requirements of the scenario's section `expect` on the log of a plant
/// (trackbed/requirement/formula.h).
namespace trackbed {

/// Evaluates a formula over the whole log. The columns of the log are the signals of the formula.
/// Errors in the formula or the log are reported in RequirementMetrics::problem and never thrown.
RequirementMetrics MeasureRequirement(const RequirementExpectation& requirement, const RunLog& log);

/// Evaluates the requirements on all plants, followed by the requirements on the plant of the log.
std::vector<RequirementMetrics> MeasureRequirements(const Expectations& expect, const RunLog& log);

/// Returns the path of a requirement's robustness in the plant's entry in metrics.json:
/// "requirements.NAME.robustness".
std::string RequirementPath(const std::string& name);

}  // namespace trackbed
