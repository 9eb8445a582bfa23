#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"

namespace trackbed {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

std::string PrintedPlan(const std::string& arguments) {
  const TempFolder folder;
  const Outcome outcome = Trackbed(folder, "plan " + arguments + " -o plan");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  return outcome.output;
}

TEST(Plan, PrintsTheTurnsOfFillets) {
  const std::string text =
      PrintedPlan(ScenarioFile("three_turns") + " --set plan.objective=turn_local");
  EXPECT_THAT(text, ContainsRegex("three_turns: planned 143.180 m in [0-9.]+ s, in plan"));
  // A heading with units below, then one row for each of the three corners.
  EXPECT_THAT(text, HasSubstr("\n  turns\n"));
  EXPECT_THAT(text, ContainsRegex("waypoint +change +radius +speed"));
  EXPECT_THAT(text, ContainsRegex("\n +\\[rad\\] +\\[m\\] +\\[m/s\\]"));
  for (const char* waypoint : {"1 +1.57", "2 +-1.57", "3 +1.57"}) {
    EXPECT_THAT(text, ContainsRegex("\n +" + std::string(waypoint)));
  }
  EXPECT_THAT(text, HasSubstr("search"));
  EXPECT_THAT(text, ContainsRegex("\n  open loop goal distance: [0-9.e-]+ m\n"));
  EXPECT_THAT(text, Not(HasSubstr(" \n"))) << "spaces at the end of a line";
}

TEST(Plan, PrintsTheStretchesAroundObstacles) {
  const std::string text = PrintedPlan(ScenarioFile("obstacle_outer_left"));
  EXPECT_THAT(text, HasSubstr("\n  avoid\n"));
  EXPECT_THAT(text, ContainsRegex("\n +\\(54.14, 5.858\\) +outer +[0-9.]+"));
  EXPECT_THAT(text, HasSubstr("\n      note: rerouted around an obstacle here\n"));
}

TEST(Plan, PrintsWhatSearchesFound) {
  const std::string text = PrintedPlan(ScenarioFile("windy_field"));
  EXPECT_THAT(text, HasSubstr("\n  legs\n"));
  EXPECT_THAT(text, ContainsRegex("\n +reached +[0-9]+ +[0-9]+"));
  EXPECT_THAT(text, HasSubstr("\n  trees\n"));
  EXPECT_THAT(text, HasSubstr("\n  corners\n"));
  EXPECT_THAT(text, HasSubstr("\n  chosen: "));
}

}  // namespace
}  // namespace trackbed
