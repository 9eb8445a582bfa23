#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/file.h"
#include "trackbed/planning/sampling/rrt_planner.h"

// Tests plans that cover only part of the route: the car drives to the end of the plan, and the run
// is not reported as an arrival.
namespace trackbed {
namespace {

using ::testing::HasSubstr;

/// A wall across the whole sampled width, 29.5 m ahead; the goal is behind it.
Scenario BeforeAWall(const std::string& rest = "") {
  return ParseScenario(
      "schema: 1\nname: wall\n"
      "mission: {speed: 3, waypoints: [[0, 0], [50, 0]]}\n"
      "world: {obstacles: [{box: {x: 30, y: 0, yaw: 0, length: 1, width: 200, height: 1}}]}\n"
      "plan: {method: rrt, trees: 3, iterations: 500, partial: true}\n" +
          rest,
      "wall.yaml", ".");
}

TEST(PartialPlan, IsDrivenToItsEndAndNotPassed) {
  const RunResult run = RunScenario(BeforeAWall());
  ASSERT_TRUE(run.plan.ok()) << run.plan->reason;
  ASSERT_EQ(run.metrics.size(), 2U);
  EXPECT_FALSE(run.verdict.passed);
  const Path& path = run.plan->reference.path;
  const Vec2 end = path.At(path.length()).pose.position();
  for (std::size_t i = 0; i < run.metrics.size(); ++i) {
    const PlantMetrics& metrics = run.metrics[i];
    SCOPED_TRACE(metrics.plant);
    EXPECT_EQ(metrics.status, DriveStatus::kPartial);
    EXPECT_EQ(metrics.partial, run.plan->partial);
    EXPECT_EQ(metrics.blocked, "");
    EXPECT_EQ(metrics.plan_changes, 0);
    EXPECT_FALSE(metrics.clearance->collision);
    // The car rests at the end of its path.
    const Vec2 stands = run.logs[i].rows.back().state.pose.position();
    EXPECT_LE((stands - end).norm(), 0.2);
    // The metric goal_distance is the distance to the goal of the mission, not to the end of the
    // partial plan.
    EXPECT_NEAR(metrics.tracking->goal_distance, (stands - Vec2(50.0, 0.0)).norm(),
                Tolerance(1e-9));
    EXPECT_THAT(run.verdict.failures.at(i), HasSubstr("did not reach the goal: partial at"));
    EXPECT_THAT(run.verdict.failures.at(i), HasSubstr("(the plan ends "));
  }
}

TEST(PartialPlan, PassesWhereThatIsWhatIsExpected) {
  const Scenario scenario = BeforeAWall(
      "drive: {plants: [kinematic]}\n"
      "expect: {metrics: [{metric: status, equals: partial}]}\n");
  const RunResult run = RunScenario(scenario);
  EXPECT_TRUE(run.verdict.passed) << testing::PrintToString(run.verdict.failures);
  EXPECT_THAT(run.verdict.notes.at(0), HasSubstr("kinematic: the plan ends "));
}

TEST(PartialPlan, StandsInTheFilesOfTheRun) {
  const RunResult run = RunScenario(BeforeAWall("drive: {plants: [kinematic]}\n"));
  const TempFolder folder;
  WriteRunFolder(run, folder.path());
  const auto plan = nlohmann::json::parse(ReadFile(folder.path() / "plan.json"));
  EXPECT_EQ(plan["status"], "ok");
  EXPECT_EQ(plan["partial"], true);
  EXPECT_EQ(plan["partial_reason"], run.plan->partial);
  EXPECT_EQ(plan["next_waypoint"], 1);
  EXPECT_GT(plan["left_m"], 20.0);
  const auto metrics = nlohmann::json::parse(ReadFile(folder.path() / "metrics.json"));
  EXPECT_EQ(metrics["plants"]["kinematic"]["status"], "partial");
  EXPECT_EQ(metrics["plants"]["kinematic"]["partial"], run.plan->partial);
}

TEST(PartialPlan, StaysOneWhenItIsPlannedAgainOnTheWay) {
  // A box that becomes known at 15 m stands beside the route's center line; the goal is behind a
  // wall.
  Scenario scenario = ParseScenario(
      "schema: 1\nname: wall\n"
      "mission: {speed: 3, waypoints: [[0, 0], [90, 0]]}\n"
      "world:\n  obstacles:\n"
      "    - box: {x: 70, y: 0, yaw: 0, length: 1, width: 200, height: 1}\n"
      "    - {box: {x: 30, y: 1, yaw: 0, length: 2, width: 2, height: 1}, known_from: {range: "
      "15}}\n"
      "plan:\n"
      "  global: {method: rrt, trees: 10, iterations: 2000, partial: true}\n"
      "  replan: {along: {method: frenet}, detour: {method: rrt, safe_distance: 0.6}}\n"
      "drive: {plants: [kinematic]}\n",
      "wall.yaml", ".");
  const RunResult run = RunScenario(scenario);
  ASSERT_TRUE(run.plan.ok()) << run.plan->reason;
  ASSERT_FALSE(run.plan->partial.empty());
  EXPECT_GT(run.metrics[0].plan_changes, 0);
  EXPECT_EQ(run.metrics[0].status, DriveStatus::kPartial);
  EXPECT_FALSE(run.metrics[0].clearance->collision);
  EXPECT_FALSE(run.verdict.passed);
}

TEST(PartialPlan, IsAMetricThatSuchAScenarioCanHave) {
  EXPECT_THAT(PossibleMetrics(BeforeAWall()), testing::Contains("partial"));
  Scenario scenario = BeforeAWall();
  scenario.plan->global = RrtPlannerOptions{};
  EXPECT_THAT(PossibleMetrics(scenario), testing::Not(testing::Contains("partial")));
}

}  // namespace
}  // namespace trackbed
