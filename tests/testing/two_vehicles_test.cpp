#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <tuple>

#include "trackbed/testing/scenario_testing.h"

/// Tests a steered car and a differential-drive vehicle on the same slalom.
namespace trackbed {
namespace two_vehicles_test {

std::filesystem::path File(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml");
}

class SlalomByEither : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

INSTANTIATE_TEST_SUITE_P(TwoVehicles, SlalomByEither,
                         testing::Combine(testing::Values("prius", "diff_drive"),
                                          testing::Values("preview", "lqr")),
                         [](const auto& pair) {
                           return std::string(std::get<0>(pair.param)) + "_" +
                                  std::get<1>(pair.param);
                         });

TEST_P(SlalomByEither, IsCompletedOnBothPlants) {
  const auto& [model, method] = GetParam();
  const RunResult run = RunScenario(
      File("slalom"),
      {fmt::format("vehicle.model={}", model), fmt::format("control={{method: {}}}", method)});
  ASSERT_EQ(run.logs.size(), 2U);
  EXPECT_THAT(run, MeetsItsExpectations());
  EXPECT_THAT(run, TracksWithin(0.15));
  EXPECT_THAT(run, ReachesGoal(0.5));
}

TEST(DiffDrive, TurnsTighterThanACarCan) {
  // The route has turns of 120 degrees between legs of 6 m. There is no plan for the Prius, which
  // needs a radius of 5.1 m and distance to turn its wheels.
  const std::vector<std::string> tight{
      "mission.waypoints=[[0, 0], [6, 0], [3, 5.2], [9, 5.2], [6, 10.4], [12, 10.4]]",
      "mission.speed=1", "control={method: preview, distance: 0.6}"};
  std::vector<std::string> diff_drive = tight;
  diff_drive.emplace_back("vehicle.model=diff_drive");
  EXPECT_FALSE(RunScenario(File("slalom"), tight).plan.ok());
  const RunResult run = RunScenario(File("slalom"), diff_drive);
  ASSERT_TRUE(run.plan.ok());
  EXPECT_THAT(run, MeetsItsExpectations());
}

TEST(DiffDrive, FeelsTheObstacleThatItHits) {
  const RunResult run = RunScenario(File("hit_the_box"), {"vehicle.model=diff_drive"});
  for (const PlantMetrics& metrics : run.metrics) {
    ASSERT_TRUE(metrics.clearance.has_value());
    EXPECT_TRUE(metrics.clearance->collision);
    // 80 kg stop from 3 m/s within centimeters, so the force is many times the weight.
    EXPECT_EQ(metrics.clearance->force_max > 1500.0, metrics.plant == "mujoco");
  }
}

TEST(DiffDrive, IsDisturbedAsCarsAre) {
  // The disturbances act on the steering angle that corresponds to the ratio of the wheel speeds.
  const RunResult run = RunScenario(
      File("slalom"),
      {"vehicle.model=diff_drive", "drive.time_limit=20", "expect={}",
       "disturb={steering: {factor: 0.9, delay: 0.1, backlash: 0.01}, kicks: [{at: 5, impulse: "
       "20}, {at: 8, displacement: 0.2}]}"});
  ASSERT_EQ(run.logs.size(), 2U);
  for (const RunLog& log : run.logs) {
    EXPECT_EQ(log.status, DriveStatus::kTimeLimit) << log.plant;
    EXPECT_LT(std::abs(log.rows.back().tracking->cross_track), 0.1) << log.plant;
  }
}

}  // namespace two_vehicles_test
}  // namespace trackbed
