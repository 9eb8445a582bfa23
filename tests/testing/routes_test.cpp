#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "trackbed/core/angle.h"
#include "trackbed/testing/scenario_testing.h"

// Tests plans around obstacles and to goals with headings on both plants.
namespace trackbed {
namespace routes_test {

std::filesystem::path File(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml");
}

TEST(Routes, ParkInAFreeBayBackwards) {
  const RunResult run = RunScenario(File("parking_lot"));
  EXPECT_THAT(run, MeetsItsExpectations());
  EXPECT_EQ(run.plan->reference.path.segments().back().direction, -1);
  EXPECT_NEAR(AngleDifference(run.plan->goal.yaw, 1.5708), 0.0, 1e-9);
}

TEST(Routes, LeadAroundARowOfCarsOnAGrid) {
  EXPECT_THAT(RunScenario(File("parking_lot_astar")), MeetsItsExpectations());
}

TEST(Routes, AreRefusedWithTheirCorners) {
  const RunResult run = RunScenario(File("parking_lot_astar"), {"plan.corners=refuse"});
  EXPECT_EQ(run.plan->status, PlanStatus::kTurnTooTight);
}

TEST(Routes, GoWithTheStreamInAWindyField) {
  const RunResult run = RunScenario(File("windy_field"));
  EXPECT_THAT(run, MeetsItsExpectations());
  const auto score = [](const RunResult& other) {
    const auto diagnostics = DiagnosticsJson(other.plan);
    return diagnostics["trees"].at(diagnostics["chosen"].get<std::size_t>());
  };
  EXPECT_GT(score(run)["wind_m"], 0.0);
  const RunResult again =
      RunScenario(File("windy_field"), {"drive.plants=[kinematic]", "expect={}"});
  EXPECT_EQ(again.plan->reference.path.segments(), run.plan->reference.path.segments());
  // If the wind blows against the car, the planner cannot use the route with the wind, and the
  // score is higher.
  const RunResult against = RunScenario(
      File("windy_field"), {"drive.plants=[kinematic]", "expect={}", "world.wind.gusts[0].x=-12"});
  EXPECT_GT(score(against)["total_m"], score(run)["total_m"]);
}

TEST(Routes, MeetAGoalWithItsHeading) {
  const RunResult forwards = RunScenario(File("heading_goal"));
  EXPECT_THAT(forwards, MeetsItsExpectations());
  const RunResult either = RunScenario(File("heading_goal"), {"plan.method=reeds_shepp"});
  EXPECT_THAT(either, MeetsItsExpectations());
  EXPECT_LT(either.plan->reference.path.length(), forwards.plan->reference.path.length());
  EXPECT_GT(SplitIntoLegs(either.plan->reference.path).size(), 1U);
}

}  // namespace routes_test
}  // namespace trackbed
