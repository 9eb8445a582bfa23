#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "trackbed/testing/scenario_testing.h"

namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string FailureText(const RunResult& run, const std::string& formula) {
  testing::StringMatchResultListener listener;
  EXPECT_FALSE(testing::ExplainMatchResult(Satisfies(formula), run, &listener));
  return listener.str();
}

TEST(Satisfies, SaysOfEachPlantByHowMuchWhereAndWhen) {
  const RunResult run = RunScenario(ParseScenario(
      "schema: 1\nname: straight\nmission: {speed: 3, waypoints: [[0, 0], [15, 0], [30, 0]]}\n"
      "plan: {method: fillet}\ndrive: {plants: [kinematic, single_track]}\n",
      "straight", "."));
  EXPECT_THAT(run, Satisfies("always abs(cross_track_m) < 0.5"));
  EXPECT_THAT(run, Satisfies("eventually[0, T] always speed_mps < 0.01"));
  EXPECT_THAT(run, Not(Satisfies("always speed_mps < 2")));
  EXPECT_EQ(testing::DescribeMatcher<const RunResult&>(Satisfies("always speed_mps < 2")),
            "satisfies always speed_mps < 2");
  EXPECT_THAT(
      FailureText(run, "always speed_mps < 2"),
      HasSubstr("kinematic: requirement 'always speed_mps < 2': robustness -1 at s = 0 m, t "
                "= 0 s; single_track: requirement"));
  EXPECT_THAT(FailureText(run, "always speed < 2"),
              HasSubstr("column 8 of the formula: unknown signal 'speed'"));
  EXPECT_THAT(FailureText(run, "always[900, 901] speed_mps < 2"),
              HasSubstr("no sample decides it"));
}

TEST(Satisfies, IsNotARunWithoutAPlan) {
  RunResult run;
  run.plan = MakeFeasible({.status = PlanStatus::kSearchFailed, .reason = "none"}, {});
  EXPECT_EQ(FailureText(run, "always t_s < 1"), "no plan: none");
}

}  // namespace
}  // namespace trackbed
