#include "trackbed/falsify/falsify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "tests/support/case_names.h"
#include "tests/support/temp_folder.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/robustness.h"
#include "trackbed/analysis/sweep_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/falsify/counterexample.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

/// A search for the kinematic car on the winding route. Long preview distances make the car cut
/// corners. The nominal point passes; points from some preview distance on fail.
CheckedSearch MakeSearch(const TempFolder& folder, const std::string& search,
                         const std::string& more = "") {
  return CheckSearch(
      ReadStudy(folder.Write("study.yaml",
                             "schema: 1\nname: study\nscenario: " TRACKBED_SOURCE_DIR
                             "/scenarios/winding.yaml\n"
                             "set: {drive.plants: [kinematic], expect: {max_cross_track: 0.3}}\n"
                             "vary:\n"
                             "  control.distance: {distribution: uniform, from: 2, to: 10}\n"
                             "  mission.speed: {distribution: uniform, from: 1, to: 3}\n"
                             "nominal: {control.distance: 2.5, mission.speed: 2}\n"
                             "outputs: [metrics.kinematic.cross_track.max]\n"
                             "search: " +
                                 search + "\n" + more),
                {}, PossibleMetrics));
}

TEST(Falsify, FindsTheSmallestPreviewDistanceThatFails) {
  const TempFolder folder;
  for (const char* method : {"random", "surrogate", "crs2", "direct"}) {
    const CheckedSearch search =
        MakeSearch(folder, "{method: " + std::string(method) + ", runs: 40}");
    const FalsifyResult result = Falsify(search);
    ASSERT_EQ(result.status, FalsifyStatus::kBroken) << method;
    const SearchedPoint& worst = *result.counterexample;
    EXPECT_LT(worst.robustness, 0.0);
    EXPECT_EQ(worst.limit, "kinematic: cross_track.max");
    EXPECT_TRUE(result.shrunk.complete);
    // Because the car rolls without slip, its speed does not matter, and only the preview distance
    // decides whether a point passes.
    EXPECT_EQ(worst.settings[1].value, "2");
    EXPECT_LT(worst.robustness, 0.0);
    EXPECT_GT(worst.robustness, -0.05);  // the tolerance for a range of 8 m is 0.08 m
    const RunResult run = RunCounterexample(result, search);
    EXPECT_FALSE(run.verdict.passed);
    EXPECT_EQ(RobustnessOf(run).value, worst.robustness);
    // If the preview distance is one tolerance nearer to the nominal point, the run passes.
    const double holds = search.space.Value(0, result.shrunk.keys[0].holds_to.value());
    EXPECT_LT(holds, std::stod(worst.settings[0].value));
    EXPECT_NEAR(holds, std::stod(worst.settings[0].value), 0.08 + 0.002);
  }
}

class ReproducibleSearch : public testing::TestWithParam<const char*> {};

TEST_P(ReproducibleSearch, IsTheSameForAnyNumberOfJobsAndAfterAnInterruption) {
  const TempFolder folder;
  const CheckedSearch search = MakeSearch(folder, GetParam());
  const nlohmann::ordered_json header = FalsifyHeader(search);
  SweepRecords whole = SweepRecords::InMemory(header);
  const nlohmann::ordered_json expected = ToJson(Falsify(search, whole, {.jobs = 1}), search);
  EXPECT_EQ(expected.at("status"), "broken");
  EXPECT_GT(expected.at("violations"), 1);
  SweepRecords parallel = SweepRecords::InMemory(header);
  EXPECT_EQ(ToJson(Falsify(search, parallel, {.jobs = 4}), search), expected);
  // Interrupts the search after every few runs.
  SweepRecords parts = SweepRecords::InMemory(header);
  int interruptions = 0;
  for (;; ++interruptions) {
    std::atomic<int> left{7};
    const FalsifyResult result = Falsify(search, parts,
                                         {.jobs = 2,
                                          .interrupted = [&] { return left <= 0; },
                                          .progress = [&](std::size_t) { --left; }});
    if (result.status != FalsifyStatus::kInterrupted) {
      EXPECT_EQ(ToJson(result, search), expected);
      break;
    }
    ASSERT_LT(interruptions, 100);
  }
  EXPECT_GT(interruptions, 3);
  ASSERT_EQ(parts.count(), whole.count());
  for (std::size_t row = 0; row < whole.count(); ++row) {
    EXPECT_EQ(parts.Read(row), whole.Read(row));
    EXPECT_EQ(parallel.Read(row), whole.Read(row));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Falsify, ReproducibleSearch,
    testing::Values("{method: crs2, runs: 24, restarts: 3, finish: cobyla, stop: false}",
                    "{method: surrogate, runs: 24, stop: false}"),
    kNamedByParameter);

TEST(Falsify, SaysWhenNothingFailed) {
  const TempFolder folder;
  const CheckedSearch search = MakeSearch(folder, "{method: latin_hypercube, runs: 10}",
                                          "derive: {drive.time_limit: 900 / mission.speed}\n");
  Study easy = search.study;
  easy.set[1].value = "{max_cross_track: 50}";
  const FalsifyResult result = Falsify(CheckSearch(easy));
  EXPECT_EQ(result.status, FalsifyStatus::kNotFalsified);
  EXPECT_EQ(result.runs, 11U);  // ten runs and the nominal point
  EXPECT_EQ(result.shrink_runs, 0U);
  EXPECT_FALSE(result.counterexample.has_value());
  EXPECT_GT(result.least.value().robustness, 0.0);
  EXPECT_EQ(result.least->settings.size(), 3U);
}

TEST(Falsify, EndsAtANominalPointThatFails) {
  const TempFolder folder;
  const CheckedSearch search = MakeSearch(folder, "{runs: 10}");
  Study failing = search.study;
  failing.set[1].value = "{max_cross_track: 0.001}";
  const FalsifyResult result = Falsify(CheckSearch(failing));
  EXPECT_EQ(result.status, FalsifyStatus::kBroken);
  EXPECT_EQ(result.runs, 1U);
  EXPECT_EQ(result.counterexample->point, search.space.nominal());
}

TEST(Falsify, CountsPointsWithoutAScenarioAndWithoutAPlan) {
  const TempFolder folder;
  // At the turn of 56 degrees, half of the shorter leg is 18.03 m. A turn by 56 degrees with the
  // radius R needs the length R tan(28 deg) of each leg, so there is no plan for radii above 33.9
  // m. A preview distance must be positive.
  const CheckedSearch search = CheckSearch(ReadStudy(
      folder.Write("study.yaml", "schema: 1\nname: study\nscenario: " TRACKBED_SOURCE_DIR
                                 "/scenarios/winding.yaml\n"
                                 "set: {drive.plants: [kinematic]}\n"
                                 "vary:\n"
                                 "  plan.radius: {distribution: uniform, from: 8, to: 60}\n"
                                 "  control.distance: {distribution: uniform, from: -2, to: 4}\n"
                                 "nominal: {plan.radius: 20, control.distance: 2.5}\n"
                                 "search: {method: sobol, runs: 16, stop: false}\n"),
      {}, PossibleMetrics));
  const FalsifyResult result = Falsify(search);
  EXPECT_GT(result.refused, 2U);
  EXPECT_GT(result.violations, 2U);
  EXPECT_EQ(result.errors, 0U);
  SweepRecords records = SweepRecords::InMemory(FalsifyHeader(search));
  Falsify(search, records);
  int without_plan = 0;
  for (std::size_t row = 0; row < records.count(); ++row) {
    const SweepRow cells = ReadRow(records, row);
    if (cells.cells[2] == "no_plan") {
      ++without_plan;
      EXPECT_EQ(cells.cells[3], "-1");
      EXPECT_EQ(cells.cells[4], "plan");
    }
    EXPECT_EQ(cells.cells[2] == "refused", cells.cells[3].empty());
  }
  EXPECT_GT(without_plan, 0);
}

TEST(Falsify, RefusesAScenarioThatExpectsNothing) {
  const TempFolder folder;
  const Study study = ReadStudy(
      folder.Write("study.yaml",
                   "schema: 1\nname: study\nscenario: " TRACKBED_SOURCE_DIR
                   "/scenarios/steering_circle.yaml\nset: {expect: {}, drive.plants: [kinematic]}\n"
                   "vary: {mission.speed: {distribution: uniform, from: 1, to: 4}}\n"
                   "search: {runs: 4}\nnominal: {mission.speed: 2}\n"));
  try {
    Falsify(CheckSearch(study));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("expect: a search needs a scenario that expects something"));
  }
}

}  // namespace
}  // namespace trackbed
