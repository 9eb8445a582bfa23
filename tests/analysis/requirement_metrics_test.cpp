#include "trackbed/analysis/requirement_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/analysis/margins.h"
#include "trackbed/analysis/metric_registry.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/file.h"
#include "trackbed/requirement/formula.h"
#include "trackbed/scenario/log_columns.h"

// Tests the requirements of `expect` from the log to the verdict.
namespace trackbed {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Scenario CornerWith(const std::string& expect) {
  return ParseScenario(
      "schema: 1\nname: required\nmission: {speed: 3, waypoints: [[0, 0], [30, 0], [30, 30]]}\n"
      "plan: {method: fillet}\ndrive: {plants: [kinematic, single_track]}\nexpect:\n" +
          expect,
      "required", TRACKBED_SOURCE_DIR "/tests/data/models", {}, PossibleMetrics);
}

/// A log of positions, one row per second, at stations 10 m apart.
RunLog LogOf(const std::vector<double>& x) {
  RunLog log{.plant = "kinematic", .configurations = Table({"t_s"})};
  for (std::size_t i = 0; i < x.size(); ++i) {
    LogRow row;
    row.state.time = static_cast<double>(i);
    row.state.pose.x = x[i];
    row.state.distance = 10.0 * static_cast<double>(i);
    log.rows.push_back(row);
  }
  return log;
}

TEST(RequirementMetrics, HaveTheSampleThatDecides) {
  const RequirementMetrics metrics =
      MeasureRequirement({"near", "always x_m < 2"}, LogOf({0.0, 2.5, 3.0, 1.0}));
  EXPECT_EQ(metrics.robustness, -1.0);
  EXPECT_FALSE(metrics.satisfied);
  EXPECT_EQ(metrics.s, 20.0);
  EXPECT_EQ(metrics.t, 2.0);
  const Check check = CheckRequirement("kinematic", metrics);
  EXPECT_FALSE(check.met);
  EXPECT_EQ(FailureMessage(check),
            "kinematic: requirement 'near': robustness -1 at s = 20 m, t = 2 s");
}

TEST(RequirementMetrics, OfRobustnessZeroAreMetUnlessTheComparisonIsStrict) {
  const RunLog log = LogOf({0.0, 2.0});
  EXPECT_TRUE(CheckRequirement("a", MeasureRequirement({"n", "always x_m <= 2"}, log)).met);
  const Check strict = CheckRequirement("a", MeasureRequirement({"n", "always x_m < 2"}, log));
  EXPECT_FALSE(strict.met);
  EXPECT_EQ(
      FailureMessage(strict),
      "a: requirement 'n': robustness 0, which its strict comparison excludes, at s = 10 m, t "
      "= 1 s");
}

TEST(RequirementMetrics, ThatNoSampleDecidesOrThatCannotBeEvaluatedAreNotMet) {
  const RunLog log = LogOf({0.0, std::nan(""), 1.0});
  const auto message = [&](const char* formula) {
    const Check check = CheckRequirement("a", MeasureRequirement({"n", formula}, log));
    EXPECT_FALSE(check.met) << formula;
    return FailureMessage(check);
  };
  EXPECT_EQ(
      message("always[50, 60] y_m < 2"),
      "a: requirement 'n': no sample decides it: its windows begin after the end of the log, 2 "
      "s long");
  EXPECT_EQ(message("always x_m < 2"), "a: requirement 'n': x_m is nan at t = 1 s");
  EXPECT_EQ(
      message("always z_m < 2"),
      "a: requirement 'n': column 8 of the formula: unknown signal 'z_m'; did you mean 'x_m'?");
}

TEST(RequirementMetrics, AreChecksOfTheVerdictAndMetrics) {
  const RunResult run = RunScenario(
      CornerWith("  requirements:\n"
                 "    - {name: lane, formula: always abs(cross_track_m) < 5}\n"
                 "    - {name: slow, formula: always speed_mps <= 2}\n"
                 "  kinematic: {metrics: [{metric: requirements.lane.robustness, min: 4}]}\n"));
  ASSERT_EQ(run.metrics.size(), 2U);
  EXPECT_FALSE(run.verdict.passed);
  for (std::size_t i = 0; i < 2; ++i) {
    const PlantMetrics& plant = run.metrics[i];
    SCOPED_TRACE(plant.plant);
    ASSERT_EQ(plant.requirements.size(), 2U);
    // The reference is computed from the rows of the log. Absolute values and differences are exact
    // to an ulp of 5.
    double furthest = 0.0;
    double fastest = 0.0;
    for (const LogRow& row : run.logs[i].rows) {
      furthest = std::max(furthest, std::abs(row.tracking->cross_track));
      fastest = std::max(fastest, row.state.speed);
    }
    EXPECT_NEAR(*plant.requirements[0].robustness, 5.0 - furthest, Tolerance(1e-15));
    EXPECT_TRUE(plant.requirements[0].satisfied);
    EXPECT_NEAR(*plant.requirements[1].robustness, 2.0 - fastest, Tolerance(1e-15));
    EXPECT_FALSE(plant.requirements[1].satisfied);
    const nlohmann::ordered_json json = ToJson(plant);
    EXPECT_EQ(json["requirements"]["lane"]["robustness"], *plant.requirements[0].robustness);
    EXPECT_EQ(json["requirements"]["slow"]["robustness_t"], plant.requirements[1].t);
  }
  EXPECT_THAT(run.verdict.failures,
              ElementsAre(StartsWith("kinematic: requirement 'slow': robustness -1 at s = "),
                          StartsWith("single_track: requirement 'slow': robustness -1 at s = ")));
  const nlohmann::ordered_json checks = ToJson(run.verdict)["checks"];
  const auto found = std::find_if(checks.begin(), checks.end(), [](const auto& check) {
    return check["metric"] == "requirements.slow.robustness";
  });
  ASSERT_NE(found, checks.end());
  EXPECT_EQ((*found)["formula"], "always speed_mps <= 2");
  EXPECT_EQ((*found)["relation"], "at_least");
  EXPECT_EQ((*found)["bound"], 0.0);
  EXPECT_EQ((*found)["met"], false);
}

TEST(RequirementMetrics, AreDescribed) {
  const Scenario scenario = CornerWith("  requirements: [{name: lane, formula: x_m < 5}]\n");
  EXPECT_THAT(PossibleMetrics(scenario), Contains("requirements.lane.robustness"));
  const auto info = DescribeMetric("requirements.lane.robustness");
  ASSERT_TRUE(info);
  EXPECT_EQ(info->label, "Robustness of lane");
  EXPECT_EQ(DescribeMetric("requirements.lane.robustness_t")->unit, "s");
  EXPECT_FALSE(DescribeMetric("requirements.lane"));
  EXPECT_FALSE(DescribeMetric("requirements.robustness"));
  EXPECT_THROW(RegisterMetric({.path = "requirements.own",
                               .label = "Own",
                               .measure = [](const MetricInput&) { return std::nullopt; }}),
               std::runtime_error);
}

TEST(RequirementMetrics, AloneMakeARunJudged) {
  PlantMetrics plant{.plant = "kinematic"};
  EXPECT_FALSE(Judge({}, {plant}, {}).judged);
  Expectations expect;
  expect.all.requirements = {{"on", "eventually t_s > 0.4"}};
  plant.requirements = {{.name = "on", .robustness = 0.1, .satisfied = true}};
  const Verdict verdict = Judge(expect, {plant}, {});
  EXPECT_TRUE(verdict.judged);
  EXPECT_TRUE(verdict.passed);
}

TEST(Margins, AreTheDistancesOfAllChecksFromTheirViolation) {
  RunResult run;
  PlantMetrics plant{.plant = "kinematic"};
  plant.tracking =
      TrackingMetrics{.corridor = 2.0, .cross_track_max = 0.5, .cross_track_max_t = 3.0};
  plant.clearance = ClearanceMetrics{.min = 0.75};
  plant.steering_rate_max = 0.5;
  plant.steering_rate_limit = 1.0;
  plant.plan_changes = 3;
  plant.requirements = {{.name = "lane", .robustness = -0.25, .t = 7.0},
                        {.name = "never", .problem = "no sample decides it"}};
  run.metrics = {plant};
  Expectations expect;
  expect.all.metrics = {{.metric = "distance", .min = 1.0, .max = {}, .equals = {}},
                        {.metric = "plan_changes", .min = {}, .max = {}, .equals = "1"}};
  run.verdict = Judge(expect, run.metrics, {});
  const std::vector<ExpectationMargin> margins = Margins(run);
  ASSERT_EQ(margins.size(), run.verdict.checks.size());
  const auto margin = [&](const std::string& metric) {
    const auto found = std::find_if(margins.begin(), margins.end(), [&](const auto& own) {
      return own.name == "kinematic " + metric;
    });
    EXPECT_NE(found, margins.end()) << metric;
    return found == margins.end() ? ExpectationMargin{} : *found;
  };
  EXPECT_EQ(margin("cross_track.max").margin, 1.5);
  EXPECT_EQ(margin("cross_track.max").unit, "m");
  EXPECT_EQ(margin("cross_track.max").at.t, 3.0);
  EXPECT_TRUE(margin("cross_track.max").met);
  EXPECT_NEAR(*margin("steering_rate_max").margin, 1.03 - 0.5, Tolerance(1e-15));
  EXPECT_EQ(margin("collision").margin, 0.75);
  EXPECT_EQ(margin("collision").unit, "m");
  EXPECT_EQ(margin("distance").margin, -1.0);
  EXPECT_FALSE(margin("distance").met);
  EXPECT_EQ(margin("plan_changes").margin, -2.0);
  EXPECT_EQ(margin("requirements.lane.robustness").margin, -0.25);
  EXPECT_EQ(margin("requirements.lane.robustness").at.t, 7.0);
  EXPECT_EQ(margin("requirements.never.robustness").margin, std::nullopt);
  EXPECT_FALSE(margin("requirements.never.robustness").met);
  EXPECT_EQ(margin("status").margin, std::nullopt);
  EXPECT_TRUE(margin("status").met);
}

TEST(Margins, OfAnExpectedCollisionIsMinusTheClearance) {
  RunResult run;
  PlantMetrics plant{.plant = "kinematic"};
  plant.clearance = ClearanceMetrics{.min = 0.75};
  run.metrics = {plant};
  Expectations expect;
  expect.all.collision = true;
  run.verdict = Judge(expect, run.metrics, {});
  const auto margins = Margins(run);
  const auto found = std::find_if(margins.begin(), margins.end(), [](const auto& own) {
    return own.name == "kinematic collision";
  });
  ASSERT_NE(found, margins.end());
  EXPECT_EQ(found->margin, -0.75);
  EXPECT_FALSE(found->met);
}

// Every formula on the page is accepted for a scenario with obstacles.
TEST(RequirementsPage, HasFormulasThatAreRead) {
  std::istringstream page(
      ReadFile(std::string(TRACKBED_SOURCE_DIR) + "/docs/how-to/requirements.md"));
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: page\nmission: {speed: 3, waypoints: [[0, 0], [30, 0], [30, 30]]}\n"
      "world: {obstacles: [{box: {x: 65, y: 0, length: 1, width: 1}}]}\nplan: {method: fillet}\n",
      "page", ".");
  bool in_block = false;
  int formulas = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      in_block = line == "```text";
    } else if (in_block) {
      EXPECT_NO_THROW(Formula::Parse(line, LogColumns(scenario, "mujoco"))) << line;
      ++formulas;
    }
  }
  EXPECT_GE(formulas, 10);
}

}  // namespace
}  // namespace trackbed
