#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

/// Scenarios in your own GoogleTest: drive one, then say what must hold.
///
///     const RunResult run = trackbed::RunScenario("scenarios/three_turns.yaml");
///     EXPECT_THAT(run, trackbed::ReachesGoal(0.5));
///     EXPECT_THAT(run, trackbed::TracksWithin(0.15));
///     EXPECT_THAT(run, trackbed::StaysWithin("kinematic", "mujoco", 0.1));
///
/// A matcher that fails says what was expected, what was, where (station) and when (time). Each
/// matcher asks every plant of the run; a run without a plan, without the plants asked for, or
/// without what is measured (a path, obstacles) does not match.
namespace trackbed {

/// Plans and drives the scenario on all its plants, with `overrides` as on the command line.
/// InputError with every problem of the file.
RunResult RunScenario(const std::filesystem::path& file,
                      const std::vector<Override>& overrides = {});

/// The same for a scenario that was filled in or changed in code.
RunResult RunScenario(const Scenario& scenario);

/// What GoogleTest prints of a run: "three_turns: kinematic arrived at 47.12 s, mujoco arrived at
/// 47.13 s; met its expectations".
void PrintTo(const RunResult& run, std::ostream* out);

/// Largest cross-track error of every plant is at most `limit` [m].
testing::Matcher<const RunResult&> TracksWithin(double limit);

/// `first` and `second` are never further apart than `limit` [m] at equal station.
testing::Matcher<const RunResult&> StaysWithin(const std::string& first, const std::string& second,
                                               double limit);

/// The outline of every plant's car stays at least `distance` [m] from every obstacle.
testing::Matcher<const RunResult&> KeepsClearOf(double distance);

/// Every plant arrives, at most `distance` [m] from the end of the path.
testing::Matcher<const RunResult&> ReachesGoal(double distance);

/// The run meets its own scenario's `expect`.
testing::Matcher<const RunResult&> MeetsItsExpectations();

}  // namespace trackbed
