#pragma once

#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// A failed run as a scenario for a test suite.
struct Regression {
  Scenario scenario;
  /// Whether the expectations describe the failure, so that the scenario passes as long as its run
  /// fails in the same way. Otherwise it has the expectations of the run, and fails.
  bool expects_failure = false;
};

/// Makes a scenario named `name` of a failed run, with the checks of its verdict as expectations of
/// each plant. Checks that were met stay; checks that failed are inverted: `max: 0.5` becomes `min:
/// 0.5` of the same metric, a requirement becomes `not (...)`, and a status or collision becomes
/// that of the run.
///
/// An expectation cannot express that there is no plan, that the wheels turn faster than the
/// actuator allows, that a metric was not measured, or that two plants differ: the expectations
/// then stay unchanged. Runs the scenario to verify that it passes.
Regression MakeRegression(const RunResult& failed, const std::string& name);

/// The text of counterexample.yaml: ResolvedYaml, with the failures in a comment. The run folder's
/// files of `failed` must lie beside it.
std::string RegressionYaml(const Regression& regression, const RunResult& failed);

}  // namespace trackbed
