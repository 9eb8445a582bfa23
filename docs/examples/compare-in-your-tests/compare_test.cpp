// Compares kinematic with dynamic tracking in a GoogleTest: drives a scenario and checks bounds on
// the differences.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trackbed/testing/scenario_testing.h"

namespace {

using trackbed::Compare;
using trackbed::DiffersByAtMost;
using trackbed::ReachesGoal;
using trackbed::RunResult;
using trackbed::RunScenario;
using trackbed::StaysWithin;
using trackbed::TracksWithin;

const char* const kCorner = SCENARIOS "/corner.yaml";

TEST(Corner, IsTrackedOnEveryPlant) {
  const RunResult run = RunScenario(kCorner);
  EXPECT_THAT(run, ReachesGoal(0.5));
  EXPECT_THAT(run, TracksWithin(0.15));
}

TEST(Corner, IsDrivenByTheTyresAsTheKinematicModelSays) {
  const RunResult run = RunScenario(kCorner);
  EXPECT_THAT(run, StaysWithin("kinematic", "mujoco:contact", 0.1));
  EXPECT_THAT(Compare(run, "kinematic", "mujoco:magic_formula"),
              DiffersByAtMost({.position_max = 0.1, .heading_max = 0.02, .steering_max = 0.05}));
}

TEST(Corner, IsNotThatOfTheKinematicModelOnIce) {
  const RunResult ice =
      RunScenario(kCorner, {"world.friction=0.02", "drive.time_limit=20", "expect={}"});
  EXPECT_THAT(ice, testing::Not(StaysWithin("kinematic", "mujoco:contact", 0.5)));
}

}  // namespace
