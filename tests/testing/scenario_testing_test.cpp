// Tests the GoogleTest matchers of trackbed::testing on whole runs of the shipped scenarios and on
// artificial results.

#include "trackbed/testing/scenario_testing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace scenario_testing_test {

namespace fs = std::filesystem;

fs::path File(const std::string& name) {
  return fs::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml");
}

/// Returns the message of the matcher for a run that does not match.
template <typename Matcher>
std::string ErrorMessage(const RunResult& run, const Matcher& matcher) {
  testing::StringMatchResultListener listener;
  EXPECT_FALSE(testing::ExplainMatchResult(matcher, run, &listener));
  return listener.str();
}

template <typename Matcher>
std::string Description(const Matcher& matcher) {
  return testing::DescribeMatcher<const RunResult&>(matcher);
}

class Scenarios : public testing::TestWithParam<std::string> {};

std::vector<std::string> AllScenarios() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(File("x").parent_path())) {
    if (entry.path().extension() == ".yaml") {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Files, Scenarios, testing::ValuesIn(AllScenarios()),
                         [](const auto& name) { return name.param; });

TEST_P(Scenarios, DriveAsTheyExpectKinematicAgainstContactDynamics) {
  const Scenario scenario = ReadScenario(File(GetParam()));
  const RunResult run = RunScenario(scenario);
  EXPECT_THAT(run, MeetsItsExpectations());
  // With the same plan at 3 m/s the plants differ by the servo's lag and tyre slip. A path-tracking
  // controller limits this difference to centimeters. In open loop, on ice or after a collision,
  // the stated bound applies.
  if (!scenario.expect.between.empty()) {
    const std::string name = GetParam();
    const double bound = name == "steering_circle"        ? 1.2
                         : name == "playback_lane_change" ? 1.0
                         : name == "ice_patch"            ? 2.0
                                                          : 0.1;
    const std::string& second = scenario.expect.between[0].plants[1];
    EXPECT_THAT(run, StaysWithin("kinematic", second, bound));
  }
  for (const PlantMetrics& metrics : run.metrics) {
    EXPECT_LE(metrics.steering_rate_max, 1.02 * 0.15056818181818182) << metrics.plant;
  }
}

TEST(Slalom, HasSixTurnsOfMoreThanSixtyDegreesBothWaysWithinTheSteeringLimit) {
  const RunResult run = RunScenario(File("slalom"), {"drive.plants=[kinematic]", "expect={}"});
  ASSERT_TRUE(run.plan.ok());
  int left = 0;
  int right = 0;
  const nlohmann::json turns = DiagnosticsJson(run.plan)["turns"];
  for (const auto& turn : turns) {
    const double heading_change = turn["heading_change_rad"];
    left += heading_change >= 1.0472 ? 1 : 0;
    right += heading_change <= -1.0472 ? 1 : 0;
    // The radius is the largest that C.40 allows, so it cannot exceed 1.2 times that value.
    EXPECT_EQ(turn["active_constraint"], "steering_room");
  }
  EXPECT_GE(left + right, 6);
  EXPECT_GE(left, 2);
  EXPECT_GE(right, 2);
}

TEST(Slalom, IsTrackedWithinFifteenCentimetersOnBothPlants) {
  const RunResult run = RunScenario(File("slalom"));
  EXPECT_THAT(run, TracksWithin(0.15));
  EXPECT_THAT(run, ReachesGoal(0.5));
}

TEST(IcePatch, IsWhatTheCarSlidesOn) {
  EXPECT_THAT(RunScenario(File("ice_patch")),
              testing::Not(StaysWithin("kinematic", "mujoco", 0.3)));
  // Without the ice, the understeer of 0.003 rad s^2/m at 2.5 m/s^2 causes a difference of at most
  // 5 cm, because the controller compensates most of it.
  EXPECT_THAT(RunScenario(File("ice_patch"), {"world.friction_patches=[]"}),
              StaysWithin("kinematic", "mujoco", 0.05));
}

TEST(TracksWithin, SaysHowFarOffWhereAndWhen) {
  const RunResult run =
      RunScenario(File("winding"), {"drive.plants=[kinematic]", "control.distance=4", "expect={}"});
  EXPECT_EQ(Description(TracksWithin(0.01)), "tracks its path within 0.01 m");
  EXPECT_THAT(ErrorMessage(run, TracksWithin(0.01)),
              testing::MatchesRegex(
                  "kinematic: cross-track error 0\\.07[0-9]* m at s = [0-9.]+ m, t = [0-9.]+ s"));
  EXPECT_THAT(run, TracksWithin(0.15));
  EXPECT_THAT(run, testing::Not(TracksWithin(0.01)));
}

TEST(StaysWithin, SaysHowFarApartWhereAndWhen) {
  const RunResult run = RunScenario(File("winding"));
  EXPECT_EQ(Description(StaysWithin("kinematic", "mujoco", 1e-5)),
            "keeps kinematic and mujoco within 1e-05 m of each other");
  EXPECT_THAT(
      ErrorMessage(run, StaysWithin("mujoco", "kinematic", 1e-5)),
      testing::MatchesRegex("position difference 0\\.00[0-9]+ m at s = [0-9.]+ m, t = [0-9.]+ s"));
  EXPECT_EQ(ErrorMessage(run, StaysWithin("mujoco", "single_track", 1.0)),
            "the run does not have both mujoco and single_track");
}

/// Comparison of two runs that differ by 0.5 in each quantity at s = 12 m.
PlantComparison HalfApart() {
  const Difference half{.rms = 0.1, .max = 0.5, .max_s = 12.0, .max_t = 4.0};
  return {.first = "kinematic",
          .second = "mujoco",
          .from_s = 0.0,
          .to_s = 138.25,
          .position = half,
          .heading = half,
          .yaw_rate = half,
          .steering = half};
}

TEST(DiffersByAtMost, SaysWhatIsExceededByHowMuchWhereAndWhen) {
  const auto matcher =
      DiffersByAtMost({.position_max = 0.3, .yaw_rate_max = 0.5, .steering_max = 0});
  EXPECT_EQ(testing::DescribeMatcher<const PlantComparison&>(matcher),
            "differ by at most 0.3 m in position, 0.5 rad/s in yaw rate, 0 rad in steering");
  EXPECT_EQ(testing::DescribeMatcher<const PlantComparison&>(
                testing::Not(DiffersByAtMost({.heading_max = 0.1}))),
            "differ by more than 0.1 rad in heading");
  testing::StringMatchResultListener listener;
  EXPECT_FALSE(testing::ExplainMatchResult(matcher, HalfApart(), &listener));
  EXPECT_EQ(listener.str(),
            "kinematic and mujoco: position difference 0.5 m exceeds 0.3 m at s = 12 m, t = 4 s; "
            "kinematic and mujoco: steering difference 0.5 rad exceeds 0 rad at s = 12 m, t = 4 s");
  EXPECT_THAT(HalfApart(), DiffersByAtMost({0.5, 0.5, 0.5, 0.5}));
  EXPECT_THAT(HalfApart(), testing::Not(DiffersByAtMost({.heading_max = 0.4})));
}

TEST(DiffersByAtMost, DoesNotMatchDrivesWithNothingInCommon) {
  const PlantComparison nothing{.first = "a", .second = "b"};
  testing::StringMatchResultListener listener;
  EXPECT_FALSE(testing::ExplainMatchResult(DiffersByAtMost({1, 1, 1, 1}), nothing, &listener));
  EXPECT_EQ(listener.str(), "a and b: cannot be compared: their station ranges do not overlap");
  RunResult run;
  run.comparisons = {nothing};
  EXPECT_EQ(ErrorMessage(run, StaysWithin("a", "b", 1.0)), "their station ranges do not overlap");
}

TEST(PlantComparison, PrintsItsLargestDifferences) {
  EXPECT_EQ(testing::PrintToString(HalfApart()),
            "kinematic and mujoco from 0 m to 138.2 m: maximum difference in position 0.5 m, "
            "heading 0.5 rad, yaw rate 0.5 rad/s, steering 0.5 rad");
}

TEST(Compare, HoldsPlantsAndRunsAgainstEachOther) {
  const RunResult run = RunScenario(File("winding"), {"drive.time_limit=6", "expect={}"});
  const RunResult other = RunScenario(
      File("winding"),
      {"name=far", "drive.plants=[kinematic]", "drive.time_limit=6", "control.distance=4"});
  const PlantComparison plants = Compare(run, "mujoco", "kinematic");
  EXPECT_EQ(plants.first, "mujoco");
  EXPECT_EQ(plants.second, "kinematic");
  EXPECT_EQ(plants.position.max, run.comparisons[0].position.max);
  const PlantComparison runs = Compare(run, other, "kinematic");
  EXPECT_EQ(runs.first, "winding/kinematic");
  EXPECT_EQ(runs.second, "far/kinematic");
  EXPECT_GT(runs.steering.max, 0.0);
  EXPECT_THAT(Compare(other, other, "kinematic"), DiffersByAtMost({0, 0, 0, 0}));
  try {
    Compare(run, other, "mujoco");
    ADD_FAILURE() << "compared a plant that was not driven";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "the run far has no plant mujoco; it has: kinematic");
  }
}

TEST(ThreeTurns, IsDrivenOnContactsAsTheKinematicModelSays) {
  // The servo lags by 10 to 15 ms. At 0.15 rad/s, the steering angle is therefore up to 2.3 mrad
  // behind, and the yaw rate by v/L = 1.1 1/s times this angle. In turns of radius 16.8 m, with a
  // yaw rate of 0.18 rad/s, the heading is 2.7 mrad behind, which is 7 mm over the preview distance
  // of 2.5 m. At 0.5 m/s^2, the slip of the tyres has a smaller effect. Without `slip`, the
  // controller steers both cars by the same law.
  EXPECT_THAT(
      Compare(RunScenario(File("three_turns"),
                          {"control.distance=2.5", "control.slip=false", "vehicle.tyre=contact"}),
              "kinematic", "mujoco"),
      DiffersByAtMost({.position_max = Tolerance(0.007),
                       .heading_max = Tolerance(0.0027),
                       .yaw_rate_max = Tolerance(0.0026),
                       .steering_max = Tolerance(0.0023)}));
}

TEST(KeepsClearance, SaysHowNearWhereAndWhen) {
  const RunResult run = RunScenario(File("obstacle_course"), {"drive.plants=[kinematic]"});
  EXPECT_EQ(Description(KeepsClearance(1.5)), "keeps a clearance of 1.5 m from obstacles");
  EXPECT_THAT(run, KeepsClearance(0.8));
  EXPECT_THAT(ErrorMessage(run, KeepsClearance(1.5)),
              testing::MatchesRegex(
                  "kinematic: clearance [01]\\.[0-9]+ m at s = [0-9.]+ m, t = [0-9.]+ s"));
  EXPECT_EQ(ErrorMessage(RunScenario(File("winding"), {"drive.plants=[kinematic]", "expect={}"}),
                         KeepsClearance(1.0)),
            "kinematic: there are no obstacles");
}

TEST(ReachesGoal, SaysHowItEnded) {
  const RunResult collided = RunScenario(File("hit_the_box"), {"drive.plants=[kinematic]"});
  EXPECT_EQ(Description(ReachesGoal(0.5)), "reaches its goal within 0.5 m");
  EXPECT_THAT(
      ErrorMessage(collided, ReachesGoal(0.5)),
      testing::MatchesRegex(
          "kinematic: did not reach the goal: collided, 3[0-9.]+ m from it, t = 1[0-9.]+ s"));
  const RunResult open_loop =
      RunScenario(File("three_turns"), {"drive.plants=[kinematic]", "control={method: schedule}"});
  EXPECT_EQ(ErrorMessage(open_loop, ReachesGoal(0.05)),
            "kinematic: stopped 0.1285 m from the goal, t = 47.12 s");
}

TEST(RunResult, PrintsHowItWent) {
  EXPECT_EQ(
      testing::PrintToString(RunScenario(File("winding"), {"drive.time_limit=0.5"})),
      "winding: kinematic time_limit at 0.5 s, mujoco time_limit at 0.5 s; expectations not met");
  EXPECT_THAT(testing::PrintToString(RunScenario(File("winding"), {"drive.plants=[kinematic]"})),
              testing::MatchesRegex("winding: kinematic arrived at [0-9.]+ s; expectations met"));
  EXPECT_EQ(testing::PrintToString(
                RunScenario(File("winding"), {"mission.waypoints=[[0, 0], [9, 0], [0, 0]]"})),
            "winding: no plan (u_turn): the route turns back on itself at waypoint 1");
}

TEST(Matchers, SayThatThereIsNoPlan) {
  const RunResult run =
      RunScenario(File("winding"), {"mission.waypoints=[[0, 0], [9, 0], [0, 0]]"});
  EXPECT_EQ(ErrorMessage(run, TracksWithin(1.0)),
            "no plan: the route turns back on itself at waypoint 1");
}

TEST(MeetsItsExpectations, ListsWhatFailed) {
  const RunResult run =
      RunScenario(File("winding"), {"drive.plants=[kinematic]", "expect={max_cross_track: 0.001}"});
  EXPECT_THAT(ErrorMessage(run, MeetsItsExpectations()),
              testing::MatchesRegex("kinematic: maximum cross-track error 0\\.[0-9]+ m exceeds "
                                    "0\\.001 m at .*"));
}

TEST(HitTheBox, IsFeltByTheContactDynamics) {
  const RunResult run = RunScenario(File("hit_the_box"));
  for (const PlantMetrics& metrics : run.metrics) {
    ASSERT_TRUE(metrics.clearance.has_value());
    EXPECT_TRUE(metrics.clearance->collision);
    // 1317 kg stop from 3 m/s within the few centimeters by which a stiff contact yields, so the
    // force is many times the car's weight. The kinematic car has no contact force.
    EXPECT_EQ(metrics.clearance->force_max > 13000.0, metrics.plant == "mujoco");
  }
}

}  // namespace scenario_testing_test
}  // namespace trackbed
