#include "trackbed/falsify/counterexample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/robustness.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

RunResult RunOf(const std::string& file, const std::vector<Override>& overrides) {
  return RunScenario(
      ReadScenario(TRACKBED_SOURCE_DIR "/scenarios/" + file, overrides, PossibleMetrics));
}

/// Reads the regression from its file and runs it.
RunResult RunAgain(const Regression& regression, const RunResult& failed) {
  return RunScenario(ParseScenario(RegressionYaml(regression, failed), "counterexample.yaml",
                                   failed.scenario.folder, {}, PossibleMetrics));
}

void ExpectKept(const RunResult& failed) {
  ASSERT_FALSE(failed.verdict.passed);
  EXPECT_LT(RobustnessOf(failed).value, 0.0);
  const Regression regression = MakeRegression(failed, "kept");
  EXPECT_TRUE(regression.expects_failure);
  const RunResult again = RunAgain(regression, failed);
  EXPECT_TRUE(again.verdict.passed) << testing::PrintToString(again.verdict.failures);
  EXPECT_EQ(again.scenario.name, "kept");
}

TEST(Counterexample, OfALimitPassesAndFailsWhenItIsMended) {
  const RunResult failed =
      RunOf("winding.yaml", {"drive.plants=[kinematic]", "control.distance=10",
                             "expect={max_cross_track: 0.3, reach_goal: 1.0}"});
  ExpectKept(failed);
  const Regression regression = MakeRegression(failed, "kept");
  EXPECT_THAT(RegressionYaml(regression, failed), HasSubstr("#   kinematic: maximum cross-track"));
  Scenario mended = regression.scenario;
  mended.control = RunOf("winding.yaml", {"drive.plants=[kinematic]"}).scenario.control;
  EXPECT_FALSE(RunScenario(mended).verdict.passed);
}

TEST(Counterexample, OfTheCorridorThatEveryRunHas) {
  ExpectKept(
      RunOf("winding.yaml", {"drive.plants=[kinematic]", "control.distance=25", "expect={}"}));
}

TEST(Counterexample, OfACollision) {
  const RunResult failed = RunOf("hit_the_box.yaml", {"drive.plants=[kinematic]", "expect={}"});
  EXPECT_LE(RobustnessOf(failed).value, -1.0);
  ExpectKept(failed);
}

TEST(Counterexample, OfARunThatDoesNotArrive) {
  ExpectKept(
      RunOf("winding.yaml", {"drive.plants=[kinematic]", "drive.time_limit=3", "expect={}"}));
}

TEST(Counterexample, OfOnePlantOfTwo) {
  const RunResult failed = RunOf("winding.yaml", {"expect={mujoco: {max_cross_track: 1e-6}}"});
  ExpectKept(failed);
}

TEST(Counterexample, OfAPlanThatIsNotFoundFailsUntilItIsMended) {
  const RunResult failed = RunOf("winding.yaml", {"drive.plants=[kinematic]", "plan.radius=40"});
  ASSERT_FALSE(failed.plan.ok());
  EXPECT_EQ(RobustnessOf(failed).value, -1.0);
  const Regression regression = MakeRegression(failed, "kept");
  EXPECT_FALSE(regression.expects_failure);
  EXPECT_FALSE(RunAgain(regression, failed).verdict.passed);
  EXPECT_THAT(RegressionYaml(regression, failed), HasSubstr("fails until it is mended"));
}

TEST(Counterexample, IsOfARunThatFailed) {
  const RunResult passed = RunOf("winding.yaml", {"drive.plants=[kinematic]"});
  EXPECT_THROW(MakeRegression(passed, "kept"), PreconditionError);
}

TEST(Robustness, IsTheShareOfTheLimitThatIsLeft) {
  const RunResult run = RunOf("winding.yaml", {"drive.plants=[kinematic]", "expect={}"});
  const PlantMetrics& metrics = run.metrics.front();
  const double error = metrics.tracking->cross_track_max;
  const auto expecting = [&](const std::string& expect) {
    return RobustnessOf(RunOf("winding.yaml", {"drive.plants=[kinematic]", "expect=" + expect}));
  };
  // Without an expectation, the limit is the width of the corridor, which is the car's width.
  EXPECT_EQ(RobustnessOf(run).value,
            (metrics.tracking->corridor - error) / metrics.tracking->corridor);
  EXPECT_EQ(RobustnessOf(run).limit, "kinematic: cross_track.max");
  EXPECT_EQ(expecting("{max_cross_track: 10}").value, (10.0 - error) / 10.0);
  EXPECT_EQ(expecting("{max_cross_track: 0.001}").value, (0.001 - error) / 0.001);
  // The smallest robustness counts. With a bound of 0, the robustness is absolute, in the unit of
  // the metric.
  const double final = metrics.tracking->cross_track_final;
  EXPECT_EQ(
      expecting("{max_cross_track: 1e4, metrics: [{metric: cross_track.final, max: 0}]}").value,
      std::min(-final, 1.0 - error / 1e4));
  // A violation without a numerical extent counts as -1.
  EXPECT_EQ(expecting("{max_cross_track: 10, metrics: [{metric: status, equals: collided}]}").value,
            -1.0);
}

}  // namespace
}  // namespace trackbed
