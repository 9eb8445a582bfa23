#pragma once

#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// A scenario for a test suite, made from a failed run.
struct Regression {
  Scenario scenario;
  /// Whether the expectations describe the failure, so that the scenario passes as long as its run
  /// fails in the same way. If false, the scenario has the original expectations of the run, and
  /// fails.
  bool expects_failure = false;
};

/// Makes a scenario named `name` from a failed run, with the checks of its verdict as expectations
/// of each plant. Expectations that were met stay unchanged. Expectations that failed are inverted:
/// `max: 0.5` becomes `min: 0.5` of the same metric, a requirement becomes `not (...)`, and an
/// expected status or collision becomes that of the run.
///
/// Expectations cannot express some failures: a missing plan, wheels that turn faster than the
/// actuator allows, an unmeasured metric, or two plants that differ. For such failures, the
/// expectations stay unchanged. The function runs the scenario to verify that it passes.
Regression MakeRegression(const RunResult& failed, const std::string& name);

/// Returns the text of counterexample.yaml: ResolvedYaml, with the failures in a comment. The input
/// files from the run folder of `failed` must be in the same folder as counterexample.yaml.
std::string RegressionYaml(const Regression& regression, const RunResult& failed);

}  // namespace trackbed
