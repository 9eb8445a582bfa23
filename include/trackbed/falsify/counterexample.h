#pragma once

#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// A scenario for a test suite that reproduces a failed run.
struct Regression {
  Scenario scenario;
  /// If true, the expectations of the scenario describe the failure, so the scenario passes as long
  /// as its run fails in the same way. If false, the scenario has the original expectations of the
  /// run, which fail.
  bool expects_failure = false;
};

/// Makes a scenario named `name` from a failed run. The checks in the run's verdict become
/// expectations on each plant. Expectations that the failed run met stay unchanged in the new
/// scenario. Expectations that the failed run did not meet are inverted. The expectation `max: 0.5`
/// becomes `min: 0.5` of the same metric, a requirement becomes `not (...)`, and an expected status
/// or collision is replaced by that of the run.
///
/// Some failures cannot be expressed as expectations: a missing plan, wheels that turn faster than
/// the actuator allows, an unmeasured metric, or two plants that differ. If a failure cannot be
/// expressed, the new scenario keeps the original expectations. MakeRegression runs the scenario
/// with the inverted expectations, and keeps the original expectations unless this run passes.
Regression MakeRegression(const RunResult& failed, const std::string& name);

/// Returns the text of counterexample.yaml: the output of ResolvedYaml, and a comment with the
/// failures. The input files from the run folder of `failed` must be copied to the folder of
/// counterexample.yaml.
std::string RegressionYaml(const Regression& regression, const RunResult& failed);

}  // namespace trackbed
