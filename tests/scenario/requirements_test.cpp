#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/error_text.h"
#include "trackbed/core/error.h"
#include "trackbed/scenario/log_columns.h"
#include "trackbed/scenario/scenario.h"

// Tests `expect.requirements` of a scenario file.
namespace trackbed {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Scenario ReadWith(const std::string& expect, const std::vector<Override>& overrides = {}) {
  return ParseScenario(
      "schema: 1\nname: required\nmission: {speed: 3, waypoints: [[0, 0], [40, 0], [40, 40]]}\n"
      "plan: {method: fillet}\nexpect:\n" +
          expect,
      "test.yaml", ".", overrides);
}

std::string RejectionMessage(const std::string& expect,
                             const std::vector<Override>& overrides = {}) {
  return ErrorText([&] { ReadWith(expect, overrides); });
}

TEST(ExpectedRequirements, AreReadForAllPlantsAndForOneAndWrittenAgain) {
  const Scenario scenario = ReadWith(
      "  requirements: [{name: lane, formula: 'always abs(cross_track_m) < 0.5'}]\n"
      "  mujoco:\n    requirements:\n"
      "      - {name: load, formula: 'always normal_force_fl_N > 0'}\n");
  ASSERT_EQ(scenario.expect.all.requirements.size(), 1U);
  EXPECT_EQ(scenario.expect.all.requirements[0].name, "lane");
  EXPECT_EQ(scenario.expect.all.requirements[0].formula, "always abs(cross_track_m) < 0.5");
  const Scenario again = ParseScenario(ResolvedYaml(scenario), "resolved.yaml", ".");
  ASSERT_EQ(again.expect.plants.size(), 1U);
  EXPECT_EQ(again.expect.plants[0].second.requirements[0].formula, "always normal_force_fl_N > 0");
}

TEST(ExpectedRequirements, AreRefusedWithTheLineAndTheColumnOfTheFormula) {
  EXPECT_EQ(
      RejectionMessage(
          "  requirements:\n    - {name: lane, formula: 'always abs(cross_trak_m) < 1'}\n"),
      "test.yaml:7:29: expect.requirements[0].formula: column 12 of the formula: unknown signal "
      "'cross_trak_m'; did you mean 'cross_track_m'?");
  EXPECT_THAT(RejectionMessage("  requirements: [{name: lane, formula: 'x_m <'}]\n"),
              HasSubstr("column 6 of the formula: expected a number or signal, found the end"));
  EXPECT_THAT(
      RejectionMessage("  requirements: [{name: Lane, formula: 'x_m < 1'}]\n"),
      HasSubstr("expect.requirements[0].name: 'Lane' must be up to 100 of a-z, 0-9 and '_'"));
  EXPECT_THAT(RejectionMessage("  requirements: [{name: lane}]\n"),
              HasSubstr("expect.requirements[0].formula: missing"));
  EXPECT_THAT(
      RejectionMessage("  requirements: [{name: a, formula: 'x_m < 1'}]\n"
                       "  kinematic: {requirements: [{name: a, formula: 'y_m < 1'}]}\n"),
      HasSubstr("expect.kinematic.requirements[0].name: 'a' is the name of two requirements"));
  EXPECT_EQ(RejectionMessage("  mujoco: {requirements: [{name: a, formula: 'y_m < 1'}]}\n"
                             "  kinematic: {requirements: [{name: a, formula: 'y_m < 1'}]}\n"),
            "");
}

TEST(ExpectedRequirements, MayUseTheColumnsThatTheLogOfTheirPlantHas) {
  const auto why = [](const std::string& formula, const std::vector<Override>& overrides = {}) {
    return RejectionMessage("  requirements: [{name: a, formula: '" + formula + "'}]\n", overrides);
  };
  EXPECT_THAT(
      why("normal_force_fl_N > 0"),
      HasSubstr("the log of kinematic has no column normal_force_fl_N; give the requirement "
                "for a plant that has it"));
  EXPECT_EQ(why("normal_force_fl_N > 0", {"drive.plants=[mujoco]"}), "");
  EXPECT_THAT(why("clearance_m > 0"), HasSubstr("unknown signal 'clearance_m'"));
  EXPECT_EQ(why("clearance_m > 0", {"world.obstacles=[{box: {x: 0, y: 9, length: 1, width: 1}}]"}),
            "");
  EXPECT_THAT(why("measured_x_m > 0"), HasSubstr("unknown signal 'measured_x_m'"));
  EXPECT_EQ(why("measured_x_m < 99", {"disturb.noise.position=0.1"}), "");
  EXPECT_THAT(why("search_cost < 1"), HasSubstr("unknown signal 'search_cost'"));
  EXPECT_EQ(why("search_cost < 1", {"control={method: optimal_steering}"}), "");
}

TEST(ExpectedRequirements, OfAScenarioFilledInByCodeAreChecked) {
  Scenario scenario = ReadWith("  {}\n");
  scenario.expect.all.requirements = {{"lane", "always x < 1"}};
  try {
    CheckScenario(scenario);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("expect.requirements[0].formula: column 8 of the formula"));
  }
}

TEST(LogColumns, AreThoseOfThePlant) {
  const Scenario scenario = ReadWith("  {}\n");
  EXPECT_THAT(LogColumns(scenario, "mujoco"), Contains("slip_ratio_rr"));
  EXPECT_THAT(LogColumns(scenario, "kinematic"), Not(Contains("slip_ratio_rr")));
  EXPECT_THAT(LogColumns(scenario, "kinematic"), Contains("cross_track_m"));
  EXPECT_THAT(LogColumns({}).front(), "t_s");
}

}  // namespace
}  // namespace trackbed
