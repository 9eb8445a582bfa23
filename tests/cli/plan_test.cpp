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

TEST(Verbs, RefuseAStartInsideAnObstacleAlike) {
  const TempFolder folder;
  folder.Write("inside.yaml",
               "schema: 1\nname: inside\nmission: {speed: 3, waypoints: [[0, 0], [40, 0]]}\n"
               "world: {obstacles: [{box: {x: 1, y: 0, length: 1, width: 1}}]}\n"
               "plan: {method: dubins}\n");
  const Outcome check = Trackbed(folder, "check inside.yaml");
  EXPECT_EQ(check.code, 2);
  EXPECT_THAT(check.output, HasSubstr("world.obstacles[0] at (1, 0) overlaps the car"));
  for (const char* verb : {"check -q", "run", "run -q", "plan", "plan -q", "watch"}) {
    const Outcome outcome = Trackbed(folder, std::string(verb) + " inside.yaml");
    EXPECT_EQ(outcome.code, check.code) << verb;
    EXPECT_EQ(outcome.output, check.output) << verb;
  }
  EXPECT_EQ(folder.Names(), std::vector<std::string>{"inside.yaml"});  // nothing is written
}

TEST(Verbs, PrintFailuresEvenIfQuiet) {
  const TempFolder folder;
  folder.Write("beyond.yaml",
               "schema: 1\nname: beyond\nmission: {speed: 3, waypoints: [[0, 0], [40, 0]]}\n"
               "world: {obstacles: [{box: {x: 40, y: 0, length: 1, width: 1}}]}\n"
               "plan: {method: dubins}\n");
  for (const char* verb : {"run -q", "plan -q"}) {
    const Outcome outcome = Trackbed(folder, std::string(verb) + " beyond.yaml");
    EXPECT_EQ(outcome.code, 3) << verb;
    EXPECT_THAT(outcome.output, testing::StartsWith("beyond: no plan (goal_blocked): waypoint 1 is "
                                                    "blocked: the obstacle at (40, 0) overlaps"))
        << verb;
  }
  const Outcome late =
      Trackbed(folder, "run -q " + ScenarioFile("winding") + " -o r --set drive.time_limit=0.2");
  EXPECT_EQ(late.code, 3);
  EXPECT_THAT(late.output, testing::StartsWith("winding: kinematic: did not reach the goal"));
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
