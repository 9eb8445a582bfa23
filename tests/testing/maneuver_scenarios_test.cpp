#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

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

}  // namespace
}  // namespace trackbed
