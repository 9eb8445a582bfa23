#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/tolerance.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {
namespace {

const std::filesystem::path kCommonRoadFile =
    std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios/roads/two_lanes.xml";

TEST(CommonRoad, BecomesAScenario) {
  const Scenario scenario = ReadScenario(kCommonRoadFile);
  EXPECT_EQ(scenario.name, "ZAM_TwoLanes-1_1_T-1");
  EXPECT_EQ(scenario.vehicle.model, "bmw320i");
  ASSERT_EQ(scenario.world.obstacles.size(), 2U);
  EXPECT_FALSE(scenario.world.obstacles[0].moves());
  const Obstacle& leader = scenario.world.obstacles[1];
  // 6 m/s from (25, 0) along a straight road.
  EXPECT_NEAR(FootprintAt(leader, 2.25).center.x, 25.0 + 6.0 * 2.25, Tolerance(1e-9));
  EXPECT_EQ(leader.until, 12.0);
  ASSERT_TRUE(scenario.plan);
  EXPECT_EQ(scenario.mission.start.speed, 10.0);
  ASSERT_EQ(scenario.expect.all.requirements.size(), 1U);
  EXPECT_EQ(scenario.expect.all.requirements.front().name, "goal");
}

TEST(CommonRoad, KeepsTheMotionsInTheResolvedScenario) {
  const std::string resolved = ResolvedYaml(ReadScenario(kCommonRoadFile));
  EXPECT_THAT(resolved, testing::HasSubstr("until: 12"));
  EXPECT_THAT(resolved, testing::HasSubstr("- time: 11.5"));
}

}  // namespace
}  // namespace trackbed
