// Tests where every plant hits moving obstacles, and what the logs record.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/testing/scenario_testing.h"

namespace trackbed {
namespace {

std::filesystem::path ThreeTurns() {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / "three_turns.yaml";
}

/// A box of 2 m that moves head-on along the first leg.
const char* const kOncoming =
    "world.obstacles=[{box: {x: 34, y: 0, length: 2, width: 2, height: 1.5}, velocity: {x: -3}}]";

TEST(MovingObstacle, IsMetWhereTheWaysCross) {
  const RunResult run = RunScenario(ThreeTurns(), {kOncoming, "expect={collision: true}"});
  EXPECT_THAT(run, MeetsItsExpectations());
  ASSERT_EQ(run.logs.size(), 2U);
  for (const RunLog& log : run.logs) {
    SCOPED_TRACE(log.plant);
    EXPECT_EQ(log.status, DriveStatus::kCollided);
    for (const LogRow& row : log.rows) {
      // Along the leg, the clearance is the distance between bumper and box until they touch.
      const double bumper = row.state.pose.x + 3.5;
      const double gap = 33.0 - 3.0 * row.state.time - bumper;
      if (gap > 1.0) {
        // The Prius's bumper is 3.5 to 3.7 m ahead of its rear axle.
        EXPECT_NEAR(*row.clearance, gap, 0.25);
      }
    }
  }
  const auto first_contact = [](const RunLog& log) {
    for (const LogRow& row : log.rows) {
      if (*row.clearance == 0.0) {
        return row.state.time;
      }
    }
    return -1.0;
  };
  // Both cars approach the obstacle at a relative speed of 6 m/s, so the contact times differ by at
  // most a control period.
  EXPECT_NEAR(first_contact(run.logs[0]), first_contact(run.logs[1]), 0.021);
}

TEST(MovingObstacle, PushesTheCarAndIsNotPushed) {
  const RunResult run =
      RunScenario(ThreeTurns(), {kOncoming, "expect={collision: true}", "drive.plants=[mujoco]"});
  const RunLog& log = run.logs.front();
  double force = 0.0;
  for (const LogRow& row : log.rows) {
    force = std::max(force, row.state.obstacle_force);
  }
  EXPECT_GT(force, 1e4);
  // A second later the heavy obstacle has pushed the car back.
  EXPECT_LT(log.rows.back().state.speed, -1.0);
  const Table& states = log.configurations;
  const auto column = [&](const std::string& name) {
    const auto& columns = states.columns();
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) -
                                    columns.begin());
  };
  ASSERT_LT(column("obstacle_0_x_m"), states.columns().size());
  for (std::size_t row = 0; row < states.rows(); ++row) {
    EXPECT_NEAR(states.at(row, column("obstacle_0_x_m")), -3.0 * states.at(row, 0),
                Tolerance(1e-9));
    EXPECT_EQ(states.at(row, column("obstacle_0_y_m")), 0.0);
  }
}

TEST(MovingObstacle, IsLoggedAlikeByPlantsThatKnowNoneAndWithAPayload) {
  const char* const passing =
      "world.obstacles=[{box: {x: 34, y: 6, length: 2, width: 2}, velocity: {x: -3, y: 0.25}}, "
      "{box: {x: -20, y: 0, length: 1, width: 1}}]";
  const RunResult run = RunScenario(
      ThreeTurns(), {passing, "disturb.payload={mass: 200}", "drive.time_limit=4", "expect={}"});
  ASSERT_EQ(run.logs.size(), 2U);
  const Table& kinematic = run.logs[0].configurations;
  const Table& mujoco = run.logs[1].configurations;
  ASSERT_EQ(kinematic.columns(), mujoco.columns());
  const std::size_t last = kinematic.columns().size() - 1;
  EXPECT_EQ(kinematic.columns()[last], "obstacle_0_y_m");
  for (std::size_t row = 0; row < kinematic.rows(); ++row) {
    EXPECT_EQ(kinematic.at(row, last), 0.25 * kinematic.at(row, 0));
    EXPECT_EQ(mujoco.at(row, last), kinematic.at(row, last));
  }
}

}  // namespace
}  // namespace trackbed
