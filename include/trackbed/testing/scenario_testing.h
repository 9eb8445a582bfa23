#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/run.h"

/// Runs scenarios in GoogleTest, and checks expectations on the runs.
///
///     const RunResult run = trackbed::RunScenario("scenarios/three_turns.yaml");
///     EXPECT_THAT(run, trackbed::ReachesGoal(0.5));
///     EXPECT_THAT(run, trackbed::TracksWithin(0.15));
///     EXPECT_THAT(run, trackbed::Satisfies("always[0, 5] speed_mps <= 8"));
///     EXPECT_THAT(run, trackbed::StaysWithin("kinematic", "mujoco", 0.1));
///     EXPECT_THAT(trackbed::Compare(run, "kinematic", "mujoco"),
///                 trackbed::DiffersByAtMost({.position_max = 0.1, .yaw_rate_max = 0.05}));
///
/// If a matcher fails, the test prints the value that violates the expectation, with station and
/// time. Each matcher checks every plant of the run. A matcher also fails if the run has no plan,
/// or if the run lacks a named plant. A matcher also fails if the checked quantity was not measured
/// because the run has no path or no obstacle.
namespace trackbed {

/// Prints a comparison of two plants in GoogleTest: "kinematic and mujoco from 0 m to 138.2 m:
/// maximum difference in position 0.02108 m, heading 0.01 rad, yaw rate 0.02 rad/s, steering 0.004
/// rad".
void PrintTo(const PlantComparison& comparison, std::ostream* out);

/// Matches if the differences between two plants never exceed the bounds. The matcher fails if the
/// plants have no common stations.
testing::Matcher<const PlantComparison&> DiffersByAtMost(const DifferenceBounds& bounds);

/// Prints a run in GoogleTest, such as "three_turns: kinematic arrived at 47.12 s, mujoco arrived
/// at 47.13 s; expectations met".
void PrintTo(const RunResult& run, std::ostream* out);

/// Matches if the largest cross-track error of every plant is at most `limit` [m].
testing::Matcher<const RunResult&> TracksWithin(double limit);

/// Matches if the positions of the plants `first` and `second` at equal stations are never further
/// apart than `limit` [m].
testing::Matcher<const RunResult&> StaysWithin(const std::string& first, const std::string& second,
                                               double limit);

/// Matches if the footprint of every plant's car stays at least `distance` [m] from every obstacle.
testing::Matcher<const RunResult&> KeepsClearance(double distance);

/// Matches if every plant arrives at the goal, at most `distance` [m] from the end of the path.
testing::Matcher<const RunResult&> ReachesGoal(double distance);

/// Matches if the steering command of no plant oscillates permanently, as in a limit cycle, with
/// more than the tolerated amplitude (docs/verdict.md#calm-steering). If the matcher fails, the
/// test prints amplitude, frequency and times of the oscillation.
testing::Matcher<const RunResult&> SteersCalmly();

/// Matches if the log of every plant satisfies a formula of temporal logic over the log's columns
/// (trackbed/requirement/formula.h): "always abs(cross_track_m) < 0.5". If the matcher fails, the
/// test prints the robustness, station and time of the sample that violates the formula most. The
/// matcher also fails if the formula is invalid, or if no sample of the log determines the
/// robustness.
testing::Matcher<const RunResult&> Satisfies(const std::string& formula);

/// Matches if the run meets all expectations in the `expect` section of the run's scenario.
testing::Matcher<const RunResult&> MeetsItsExpectations();

}  // namespace trackbed
