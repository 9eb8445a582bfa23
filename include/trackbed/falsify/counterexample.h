#pragma once

#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// A failed run as a scenario for a test suite.
struct Regression {
  Scenario scenario;
  /// Whether the scenario expects what the run did, so that its run passes for as long as it fails
  /// in the same way. Otherwise it has the expectations of the run, and fails.
  bool expects_failure = false;
};

/// The scenario of a run that failed, named `name`, with the checks of its verdict as expectations
/// of each plant: those that were met as they were, those that were not turned round, such as
/// `max: 0.5` to `min: 0.5` of the same metric, a requirement to `not (...)`, and a status or a
/// collision to that of the run.
///
/// No expectation can say that there is no plan, that the wheels turn faster than the actuator,
/// that a metric was not measured, or that two plants differ: then the expectations are left as
/// they are. The scenario is run to see that it passes.
Regression MakeRegression(const RunResult& failed, const std::string& name);

/// The text of counterexample.yaml: ResolvedYaml, with the failures in a comment. The files of the
/// run folder of `failed` must lie beside it.
std::string RegressionYaml(const Regression& regression, const RunResult& failed);

}  // namespace trackbed
