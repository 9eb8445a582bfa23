#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trackbed/testing/scenario_testing.h"

namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Runs a kinematic car at 5 m/s on a straight road from which it is kicked 0.3 m to the side. The
/// LQR neglects the steering's `delay` [s].
RunResult RunWithDelay(const std::string& delay) {
  return RunScenario(
      ParseScenario("schema: 1\nname: delayed\nmission: {speed: 5, waypoints: [[0, 0], [300, 0]]}\n"
                    "plan: {method: fillet}\ncontrol: {method: lqr}\ndrive: {plants: [kinematic]}\n"
                    "disturb: {steering: {delay: " +
                        delay + "}, kicks: [{at: 3, displacement: 0.3}]}\n",
                    "delayed", "."));
}

TEST(SteersCalmly, IsTheRunOfAControllerThatFitsItsCar) {
  EXPECT_THAT(RunWithDelay("0.02"), SteersCalmly());
}

TEST(SteersCalmly, IsNotALimitCycle) {
  const RunResult run = RunWithDelay("0.4");
  EXPECT_THAT(run, Not(SteersCalmly()));
  EXPECT_FALSE(run.verdict.passed);
  testing::StringMatchResultListener listener;
  testing::ExplainMatchResult(SteersCalmly(), run, &listener);
  EXPECT_THAT(listener.str(), HasSubstr("kinematic: steering oscillates by "));
  EXPECT_EQ(testing::DescribeMatcher<const RunResult&>(SteersCalmly()), "steers calmly");
}

TEST(SteersCalmly, IsNotARunWithoutAPath) {
  const RunResult run = RunScenario(ParseScenario(
      "schema: 1\nname: sine\nmission: {speed: 5, duration: 20}\n"
      "control: {method: sine_with_dwell, amplitude: 0.1, frequency: 0.5, dwell: 0.5, at: 1}\n"
      "drive: {plants: [kinematic]}\n",
      "sine", "."));
  testing::StringMatchResultListener listener;
  EXPECT_FALSE(testing::ExplainMatchResult(SteersCalmly(), run, &listener));
  EXPECT_EQ(listener.str(), "kinematic: there is no path to steer along");
}

}  // namespace
}  // namespace trackbed
