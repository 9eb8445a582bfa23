#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/support/obstacle_cases.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/drive/drive.h"
#include "trackbed/testing/scenario_testing.h"

/// Tests plans that avoid obstacles on both plants.
namespace trackbed {
namespace {

std::filesystem::path ScenarioFile(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml");
}

class DrivenRoundObstacle : public testing::TestWithParam<ObstacleCase> {};

INSTANTIATE_TEST_SUITE_P(Cases, DrivenRoundObstacle, testing::ValuesIn(AllObstacleCases()),
                         CaseName);

/// The turns of the listing have a radius of 20 m and straights of 22.7 m before and after; the
/// obstacle is a box of 2 m.
TEST_P(DrivenRoundObstacle, KeepsToThePlanAndClearOnBothPlants) {
  const ObstacleCase& c = GetParam();
  constexpr double kRadius = 20.0;
  constexpr double kStraight = 22.7 + 20.0;  // with room to leave early or return late
  const double turn = 0.5 * kPi - c.reduction;
  const double tangent = kRadius * std::tan(0.5 * turn);
  const Vec2 corner{kStraight + tangent, 0.0};

  Scenario scenario = ReadScenario(ScenarioFile("obstacle_inner_left"));
  scenario.mission.waypoints = {
      {0.0, 0.0}, corner, corner + (kStraight + tangent) * Direction(c.side * turn)};
  const double swept = turn * c.sixth / 6.0;
  Obstacle& obstacle = scenario.world.obstacles.at(0);
  obstacle.footprint.center = {kStraight + kRadius * std::sin(swept),
                               c.side * kRadius * (1.0 - std::cos(swept)), 0.0};
  std::get<BezierAvoidanceOptions>(*scenario.plan->avoid).passing_side = c.passing_side;

  const RunResult run = RunScenario(scenario);
  ASSERT_EQ(run.logs.size(), 2U);
  EXPECT_THAT(run, ReachesGoal(0.5));
  // The curvature of the path needs up to 0.9 of the steering rate. A controller with a preview
  // distance of 2.5 m cuts this path by some centimeters (0.034 m observed). The plan keeps a
  // distance of 1.5 m.
  EXPECT_THAT(run, TracksWithin(0.15));
  EXPECT_THAT(run, KeepsClearance(1.4));
  EXPECT_THAT(run, StaysWithin("kinematic", "mujoco", 0.05));
  for (const PlantMetrics& plant : run.metrics) {
    EXPECT_FALSE(plant.clearance->collision);
    EXPECT_EQ(plant.clearance->force_max, 0.0);
    EXPECT_EQ(plant.plan_changes, 0);
  }
}

TEST(ObstacleAppears, IsPassedOnANewPlanAfterTheDelay) {
  const Scenario scenario = ReadScenario(ScenarioFile("obstacle_appears"));
  const RunResult run = RunScenario(scenario);
  EXPECT_THAT(run, MeetsItsExpectations());
  for (const RunLog& log : run.logs) {
    SCOPED_TRACE(log.plant);
    ASSERT_EQ(log.changes.size(), 1U);
    const PlanChange& change = log.changes[0];
    // Finds the first row whose footprint is within range of the obstacle.
    double seen = 0.0;
    const OrientedBox& box = scenario.world.obstacles[0].footprint;
    const VehicleParams vehicle = LoadCar(scenario).params();
    for (const LogRow& row : log.rows) {
      if (Distance(FootprintAt(vehicle, row.state.pose), box) <= 25.0) {
        seen = row.state.time;
        break;
      }
    }
    EXPECT_NEAR(change.time, seen + 0.9, Tolerance(1e-9));
    // The new plan starts with the pose and steering angle at that time.
    const auto at = std::find_if(log.rows.begin(), log.rows.end(),
                                 [&](const LogRow& row) { return row.state.time == change.time; });
    ASSERT_NE(at, log.rows.end());
    const PathPoint start = change.plan.reference.path.At(0.0);
    EXPECT_EQ(start.pose, at->state.pose);
    EXPECT_NEAR(SteeringForCurvature(vehicle, start.curvature), at->state.steering,
                Tolerance(1e-12));
    EXPECT_EQ(at->tracking->cross_track, 0.0);
    // The station is continuous when the plan changes: between two rows, the car moves by 0.06 m.
    EXPECT_NEAR(at->tracking->s, (at - 1)->tracking->s, 0.07);
    // The commanded angle changes by at most the angle that the actuator turns in a period, plus
    // the correction of the previous cross-track error, which the new plan resets. The correction
    // is 2 L e/R^2 = 0.043 rad, with the wheelbase L, e = 0.05 m and the preview distance R = 2.5
    // m.
    EXPECT_NEAR(at->command.steering, (at - 1)->command.steering,
                Tolerance(0.043 + vehicle.steering_rate * 0.02));
  }
}

TEST(ObstacleAppears, WithoutAnAvoiderItIsHit) {
  Scenario scenario = ReadScenario(ScenarioFile("obstacle_appears"));
  scenario.plan->avoid.reset();
  scenario.expect = {};
  scenario.drive.plants = {"kinematic"};
  const RunResult run = RunScenario(scenario);
  EXPECT_EQ(run.logs[0].status, DriveStatus::kCollided);
  EXPECT_TRUE(run.logs[0].changes.empty());
}

TEST(ObstacleAppears, TooLateForAnyWayAroundStopsTheCar) {
  Scenario scenario = ReadScenario(ScenarioFile("obstacle_appears"));
  // The obstacle becomes known at a distance of 7.5 m. The car drives 2.7 m before the plan
  // changes, and needs 4.5 m to stop.
  scenario.world.obstacles[0].known_from_range = 7.5;
  std::get<BezierAvoidanceOptions>(*scenario.plan->avoid).safe_distance = 1.0;
  std::get<BezierAvoidanceOptions>(*scenario.plan->avoid).min_speed = 2.5;
  scenario.expect = {};
  const RunResult run = RunScenario(scenario);
  EXPECT_FALSE(run.verdict.passed);
  for (std::size_t i = 0; i < run.logs.size(); ++i) {
    EXPECT_EQ(run.logs[i].status, DriveStatus::kBlocked);
    EXPECT_THAT(run.metrics[i].blocked, testing::StartsWith("stops before the obstacle at ("));
    EXPECT_FALSE(run.metrics[i].clearance->collision);
    // The goal distance is measured from the mission's goal, not from the end of the truncated
    // path.
    EXPECT_GT(run.metrics[i].tracking->goal_distance, 40.0);
  }
  EXPECT_THAT(run.verdict.failures.at(0), testing::HasSubstr("did not reach the goal: blocked"));
}

TEST(ObstacleAppears, TheSameRunTwiceIsTheSame) {
  const Scenario scenario = ReadScenario(ScenarioFile("obstacle_appears"));
  const RunResult first = RunScenario(scenario);
  const RunResult second = RunScenario(scenario);
  for (std::size_t i = 0; i < first.logs.size(); ++i) {
    EXPECT_EQ(ToTable(first.logs[i]).ToCsv(), ToTable(second.logs[i]).ToCsv());
  }
}

}  // namespace
}  // namespace trackbed
