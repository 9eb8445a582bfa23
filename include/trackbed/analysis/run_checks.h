#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/run.h"

/// Checks of runs for tests. The GoogleTest matchers of trackbed::testing and the assertions of the
/// Python package make these checks, and therefore fail with the same texts. The matchers
/// (trackbed/testing/scenario_testing.h) have the same names, and describe what each check demands.
namespace trackbed::run_checks {

/// A check of a run.
struct RunCheck {
  std::string description;  ///< Condition on the run, such as "tracks its path within 0.1 m".
  /// Returns why a run that has a plan fails the check; empty if the run passes.
  std::function<std::vector<std::string>(const RunResult&)> failures;
};

/// Returns why a run fails the check; empty if the run passes. A run without a plan fails the
/// check.
std::vector<std::string> Failures(const RunCheck& check, const RunResult& run);

RunCheck TracksWithin(double limit);  ///< `limit`: largest cross-track error [m].
/// `limit` is the largest distance [m] between the positions of the plants `first` and `second`.
RunCheck StaysWithin(const std::string& first, const std::string& second, double limit);
RunCheck KeepsClearance(double distance);  ///< `distance`: smallest clearance [m].
RunCheck ReachesGoal(double distance);     ///< `distance`: largest distance from the goal [m].
RunCheck SteersCalmly();
RunCheck Satisfies(const std::string& formula);
RunCheck MeetsItsExpectations();

/// Describes bounds on the differences of two plants: "0.1 m in position, 0.05 rad in heading". The
/// function Exceeded returns the failures of a check of the bounds.
std::string Describe(const DifferenceBounds& bounds);

/// Describes a comparison: "kinematic and mujoco from 0 m to 138.2 m: maximum difference in
/// position 0.02108 m, heading 0.01 rad, yaw rate 0.02 rad/s, steering 0.004 rad".
std::string Describe(const PlantComparison& comparison);

/// Describes a run: "three_turns: kinematic arrived at 47.12 s, mujoco arrived at 47.13 s;
/// expectations met".
std::string Describe(const RunResult& run);

}  // namespace trackbed::run_checks
