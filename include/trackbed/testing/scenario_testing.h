#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/run.h"

/// Scenarios in GoogleTest: run a scenario, then state expectations.
///
///     const RunResult run = trackbed::RunScenario("scenarios/three_turns.yaml");
///     EXPECT_THAT(run, trackbed::ReachesGoal(0.5));
///     EXPECT_THAT(run, trackbed::TracksWithin(0.15));
///     EXPECT_THAT(run, trackbed::Satisfies("always[0, 5] speed_mps <= 8"));
///     EXPECT_THAT(run, trackbed::StaysWithin("kinematic", "mujoco", 0.1));
///     EXPECT_THAT(trackbed::Compare(run, "kinematic", "mujoco"),
///                 trackbed::DiffersByAtMost({.position_max = 0.1, .yaw_rate_max = 0.05}));
///
/// A failing matcher prints the value, the station and the time. Each matcher checks every plant of
/// the run. A run does not match if it has no plan, lacks the named plants, or lacks the measured
/// quantity because there is no path or no obstacle.
namespace trackbed {

/// Plans and simulates the scenario on all its plants. `overrides` have the form key=value, as on
/// the command line. InputError lists every problem of the file.
RunResult RunScenario(const std::filesystem::path& file,
                      const std::vector<Override>& overrides = {});

/// As RunScenario above, for a scenario made or changed in code.
RunResult RunScenario(const Scenario& scenario);

/// Returns the differences between two plants of a run. InputError unless the run has both plants.
PlantComparison Compare(const RunResult& run, const std::string& first, const std::string& second);

/// Returns the differences of a plant between two runs, for example with different controllers. The
/// compared plants are named "<run>/<plant>". InputError unless both runs have the plant.
PlantComparison Compare(const RunResult& first, const RunResult& second, const std::string& plant);

/// Prints a comparison in GoogleTest: "kinematic and mujoco from 0 m to 138.2 m: maximum difference
/// in position 0.02108 m, heading 0.01 rad, yaw rate 0.02 rad/s, steering 0.004 rad".
void PrintTo(const PlantComparison& comparison, std::ostream* out);

/// Matches if the differences never exceed the bounds. Plants without common stations do not match.
testing::Matcher<const PlantComparison&> DiffersByAtMost(const DifferenceBounds& bounds);

/// Prints a run in GoogleTest: "three_turns: kinematic arrived at 47.12 s, mujoco arrived at 47.13
/// s; expectations met".
void PrintTo(const RunResult& run, std::ostream* out);

/// Matches if the largest cross-track error of every plant is at most `limit` [m].
testing::Matcher<const RunResult&> TracksWithin(double limit);

/// Matches if the plants `first` and `second` are never further apart than `limit` [m] at equal
/// station.
testing::Matcher<const RunResult&> StaysWithin(const std::string& first, const std::string& second,
                                               double limit);

/// Matches if the footprint of every plant's car stays at least `distance` [m] from every obstacle.
testing::Matcher<const RunResult&> KeepsClearance(double distance);

/// Matches if every plant arrives, at most `distance` [m] from the end of the path.
testing::Matcher<const RunResult&> ReachesGoal(double distance);

/// Matches if the log of every plant satisfies a formula of temporal logic over its columns
/// (trackbed/requirement/formula.h): "always abs(cross_track_m) < 0.5". A failure names the
/// robustness, station and time of the decisive sample. Invalid formulas, and formulas without a
/// decisive sample, do not match.
testing::Matcher<const RunResult&> Satisfies(const std::string& formula);

/// Matches if the run meets the `expect` section of its scenario.
testing::Matcher<const RunResult&> MeetsItsExpectations();

}  // namespace trackbed
