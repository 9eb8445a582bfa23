#pragma once

#include <map>
#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

/// The outputs of a run, from which a study's table is made.
namespace trackbed {

/// The results of a run for a study's table. Each key is a dotted path, such as `plan.length_m`.
/// The paths are `metrics.<plant>.…`, `between.<plant>.<plant>.…`, `verdict.passed`,
/// `verdict.failures`, `verdict.robustness` (RobustnessOf), `plan.status`, `plan.length_m` and the
/// other PathProperties(), `timing.planning_s` (which differs between runs). The names in these
/// dotted paths are the same as in metrics.json. In a dotted path, an element of a list is written
/// as its index in brackets, such as `turns[0]`. If a run has a single plant, its results are also
/// listed as `metrics.*.…`, so that a study that varies the plant needs only one column for each
/// result.
using Outputs = std::map<std::string, std::string>;

Outputs CollectOutputs(const RunResult& result);

/// Returns the paths of all outputs that runs of the scenario may have, sorted by name.
std::vector<std::string> PossibleOutputs(const Scenario& scenario);

}  // namespace trackbed
