#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/tolerance.h"
#include "trackbed/testing/scenario_testing.h"

// Tests the standard maneuvers on the BMW, as in docs/maneuvers.md.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

fs::path Folder() {
  return fs::path(TRACKBED_SOURCE_DIR) / "scenarios" / "maneuvers";
}

std::vector<std::string> AllManeuvers() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(Folder())) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class ManeuverScenarios : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Files, ManeuverScenarios, testing::ValuesIn(AllManeuvers()),
                         [](const auto& name) { return name.param; });

TEST_P(ManeuverScenarios, MeetTheirExpectations) {
  const RunResult run = RunScenario(Folder() / (GetParam() + ".yaml"));
  EXPECT_THAT(run, MeetsItsExpectations());
  ASSERT_EQ(run.metrics.size(), 1U);
  ASSERT_TRUE(run.metrics[0].maneuver.has_value());
  // A car that rolls over ends its run before the maneuver can be evaluated.
  EXPECT_EQ(run.metrics[0].maneuver->values.empty(),
            run.metrics[0].status == DriveStatus::kRolledOver);
}

TEST(SineWithDwellScenario, IsSteeringLimitedUnlessItsRateIsRaised) {
  const fs::path file = Folder() / "iso_19365_sine_with_dwell_6_5.yaml";
  const RunResult raised = RunScenario(file);
  EXPECT_THAT(raised.verdict.notes,
              testing::ElementsAre(
                  "mujoco: the car has no electronic stability control (ESC), which ISO 19365 and "
                  "FMVSS 126 test",
                  "steering rate set to 0.5 rad/s"));
  const RunResult own = RunScenario(file, {"vehicle.steering_rate=0.4", "expect={}"});
  EXPECT_THAT(own.verdict.notes, testing::Contains(testing::MatchesRegex(
                                     "mujoco: steering limited \\([0-9]+ % of the time\\)")));
}

TEST(DriverAidScenarios, FailWithoutTheirAids) {
  const RunResult braking =
      RunScenario(Folder() / "abs_split_friction.yaml", {"vehicle.aids={}", "expect={}"});
  EXPECT_GT(*braking.metrics[0].maneuver->Find("heading_deviation_max"), 1.0);
  const RunResult steering =
      RunScenario(Folder() / "esc_sine_with_dwell.yaml", {"vehicle.aids={}", "expect={}"});
  EXPECT_EQ(steering.metrics[0].maneuver->passed, false);
}

TEST(DriverAidScenarios, LogTheStatesOfTheAids) {
  const RunResult run = RunScenario(Folder() / "esc_sine_with_dwell.yaml",
                                    {"drive.plants=[kinematic, mujoco]", "expect={}"});
  EXPECT_THAT(run.verdict.notes,
              testing::Contains("kinematic: ignores vehicle.aids; only the plants mujoco and "
                                "mujoco:magic_formula have wheels that lock and spin"));
  const Table log = ToTable(run.logs[1]);
  double braked = 0.0;  // Time with a brake torque of stability control [s].
  for (std::size_t row = 0; row + 1 < log.rows(); ++row) {
    bool acts = false;
    for (const char* wheel : {"fl", "fr", "rl", "rr"}) {
      const int column = log.Find(std::string("esc_brake_torque_") + wheel + "_Nm");
      ASSERT_GE(column, 0);
      acts = acts || log.at(row, static_cast<std::size_t>(column)) > 0.0;
    }
    braked += acts ? 0.01 : 0.0;
  }
  const auto& measured = run.metrics[1].measured;
  const auto metric = std::find_if(measured.begin(), measured.end(),
                                   [](const auto& own) { return own.first == "aids.esc_time"; });
  ASSERT_NE(metric, measured.end());
  // The sum of the control periods of 0.01 s.
  EXPECT_NEAR(std::get<double>(metric->second.value), braked, Tolerance(1e-9));
  EXPECT_GT(braked, 0.5);
  EXPECT_GE(log.Find("abs_active_rr"), 0);
  EXPECT_GE(log.Find("yaw_rate_reference_radps"), 0);
  EXPECT_LT(log.Find("differential_torque_Nm"), 0);
  EXPECT_LT(ToTable(run.logs[0]).Find("abs_active_rr"), 0);
}

}  // namespace
}  // namespace trackbed
