#pragma once

#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// A scenario for a test suite, made of a failed run.
struct Regression {
  Scenario scenario;
  /// Whether the expectations describe the failure, so that the scenario passes as long as its run
  /// fails in the same way. Otherwise the scenario has the expectations of the run, and fails.
  bool expects_failure = false;
};

/// Makes a scenario named `name` of a failed run, with the checks of its verdict as expectations of
/// each plant. Checks that were met stay unchanged. Checks that failed are inverted: `max: 0.5`
/// becomes `min: 0.5` of the same metric, a requirement becomes `not (...)`, and an expected status
/// or collision becomes that of the run.
///
/// Expectations cannot express some failures: a missing plan, wheels that turn faster than the
/// actuator allows, an unmeasured metric, or two plants that differ. The expectations then stay
/// unchanged. The function runs the scenario to verify that it passes.
Regression MakeRegression(const RunResult& failed, const std::string& name);

/// Returns the text of counterexample.yaml: ResolvedYaml, with the failures in a comment. The files
/// of `failed` in the run folder must be in the same folder.
std::string RegressionYaml(const Regression& regression, const RunResult& failed);

}  // namespace trackbed
