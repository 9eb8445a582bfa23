#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/file.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/requirement/robustness.h"
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

// The goal is the heading 0.1 to 0.5 rad, 9 to 12 s after the start. A car that starts with the
// heading 0.02 rad reaches it as 0.3 rad, whatever whole turns the initial state has.
TEST(CommonRoad, MeetsItsGoalAfterWholeTurns) {
  const std::string text = ReadFile(kCommonRoadFile);
  const std::string heading = "<exact>0.02000</exact>";
  const std::size_t at = text.find(heading, text.find("<planningProblem"));
  ASSERT_NE(at, std::string::npos);
  for (const double turn : {0.0, -2.0 * kPi, 2.0 * kPi}) {
    SCOPED_TRACE(turn);
    const TempFolder folder;
    const std::string turned = fmt::format("<exact>{:.9f}</exact>", 0.02 + turn);
    const Scenario scenario =
        ReadScenario(folder.Write("s.xml", std::string(text).replace(at, heading.size(), turned)));
    Table log({"t_s", "x_m", "y_m", "yaw_rad", "speed_mps"});
    for (const double t : {0.0, 9.0, 12.0}) {
      log.AddRow({t, 108.5177 - 1.42 * std::cos(0.3), 7.81 - 1.42 * std::sin(0.3), 0.3, 10.0});
    }
    const std::string& formula = scenario.expect.all.requirements.front().formula;
    // The nearest bounds of the interval are 0.2 rad away.
    EXPECT_NEAR(Robustness(Formula::Parse(formula, log.columns()), log), 0.2, Tolerance(1e-6));
  }
}

// A goal without a time, or with a time that no run takes, may be reached at any time.
TEST(CommonRoad, MeetsItsGoalAtAnyTime) {
  const std::string text = ReadFile(kCommonRoadFile);
  const std::size_t goal = text.find("<goalState>");
  const std::size_t begin = text.find("<time>", goal);
  const std::size_t end = text.find("</time>", begin) + std::string("</time>").size();
  ASSERT_LT(end, text.size());
  for (const std::string time :
       {"", "<time><intervalStart>0</intervalStart><intervalEnd>100000000</intervalEnd></time>"}) {
    SCOPED_TRACE(time);
    const TempFolder folder;
    const Scenario scenario =
        ReadScenario(folder.Write("s.xml", std::string(text).replace(begin, end - begin, time)));
    EXPECT_THAT(scenario.expect.all.requirements.front().formula,
                testing::StartsWith("eventually ("));
  }
}

TEST(CommonRoad, KeepsTheMotionsInTheResolvedScenario) {
  const std::string resolved = ResolvedYaml(ReadScenario(kCommonRoadFile));
  EXPECT_THAT(resolved, testing::HasSubstr("until: 12"));
  EXPECT_THAT(resolved, testing::HasSubstr("- time: 11.5"));
}

}  // namespace
}  // namespace trackbed
