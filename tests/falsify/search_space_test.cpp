#include "trackbed/falsify/search_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/falsify/falsify.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

TEST(SearchSpace, RoundsValuesButNotEndsNorNominalOnes) {
  const SearchSpace space(
      {{.key = "a", .from = 12.0, .to = 20.0, .nominal = 50.0 / 3.0},
       {.key = "n", .kind = DistributionKind::kInteger, .from = 1.0, .to = 5.0, .nominal = 2.0},
       {.key = "l",
        .kind = DistributionKind::kLogUniform,
        .from = 0.1,
        .to = 1000.0,
        .nominal = 1.0},
       {.key = "big", .from = 0.0, .to = 123456.0, .nominal = 0.0}});
  // A range of 8 is rounded to steps of 0.001, and a range of 123 456 to steps of 100.
  EXPECT_EQ(space.Value(0, 0.123456789), 12.988);
  EXPECT_EQ(space.Value(0, 0.0), 12.0);
  EXPECT_EQ(space.Value(0, 1.0), 20.0);
  EXPECT_EQ(space.Value(0, space.nominal()[0]), 50.0 / 3.0);
  EXPECT_EQ(space.Value(1, 0.6), 3.0);
  EXPECT_EQ(space.Value(2, 0.5), 10.0);
  EXPECT_EQ(space.Value(2, 0.123456789), 0.31176);  // 0.1 x 10^(4 x 0.123456789) = 0.3117648...
  EXPECT_EQ(space.Value(3, 0.5), 61700.0);
  EXPECT_EQ(ShortestText(space.Value(0, 1.0 / 3.0)), "14.667");
}

TEST(SearchSpace, TakesTheStepsOfAKey) {
  const SearchSpace space(
      {{.key = "delay", .from = 0.1, .to = 0.4, .step = 0.02, .nominal = 0.16}});
  EXPECT_EQ(ShortestText(space.Value(0, 0.5)), "0.26");  // 0.25 is 7.5 steps, rounded up
  EXPECT_EQ(ShortestText(space.Value(0, 0.18)), "0.16");
  EXPECT_EQ(ShortestText(space.Value(0, 1.0)), "0.4");
  EXPECT_EQ(space.Value(0, 0.0), 0.1);
  EXPECT_NEAR(space.Step(0), 1.0 / 15.0, Tolerance(1e-16));  // 15 steps, to rounding
  std::set<std::string> values;
  for (int i = 0; i <= 1000; ++i) {
    const UnitPoint point = space.Snap({1e-3 * i});
    EXPECT_EQ(space.Snap(point), point);
    values.insert(ShortestText(space.Value(0, point[0])));
  }
  EXPECT_THAT(values,
              testing::ElementsAre("0.1", "0.12", "0.14", "0.16", "0.18", "0.2", "0.22", "0.24",
                                   "0.26", "0.28", "0.3", "0.32", "0.34", "0.36", "0.38", "0.4"));
}

TEST(SearchSpace, SnapsToPointsOfTheSameValues) {
  const SearchSpace space(
      {{.key = "a", .from = -0.3, .to = 0.1, .nominal = 0.0},
       {.key = "l", .kind = DistributionKind::kLogUniform, .from = 2e-3, .to = 7.0, .nominal = 1.0},
       {.key = "n", .kind = DistributionKind::kInteger, .from = -3.0, .to = 8.0, .nominal = 2.0}});
  for (int i = 0; i <= 1000; ++i) {
    const double place = 1e-3 * i;
    const UnitPoint snapped = space.Snap({place, place, place});
    EXPECT_EQ(space.Snap(snapped), snapped);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(space.Value(k, snapped[k]), space.Value(k, place));
      EXPECT_LE(std::abs(snapped[k] - place), 0.5 * space.Step(k) + 1e-4);
    }
  }
}

CheckedSearch Check(const TempFolder& folder, const std::string& keys) {
  return CheckSearch(ReadStudy(
      folder.Write("study.yaml", "schema: 1\nname: study\nscenario: " TRACKBED_SOURCE_DIR
                                 "/scenarios/winding.yaml\nset: {drive.plants: [kinematic]}\n" +
                                     keys),
      {}, PossibleMetrics));
}

std::string Problems(const std::string& keys) {
  const TempFolder folder;
  try {
    Check(folder, keys);
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string name = folder.path().string() + "/";
    for (std::size_t at = 0; (at = message.find(name)) != std::string::npos;) {
      message.erase(at, name.size());
    }
    return message;
  }
  return "no error";
}

TEST(SearchSpace, TakesNominalValuesOfTheScenario) {
  const TempFolder folder;
  const CheckedSearch search = Check(folder,
                                     "vary:\n"
                                     "  mission.speed: {distribution: uniform, from: 1, to: 4}\n"
                                     "  world.friction: {distribution: uniform, from: 0.4, to: 1}\n"
                                     "search: {}\n"
                                     "nominal: {mission.speed: 2.5}\n");
  ASSERT_EQ(search.space.keys().size(), 2U);
  EXPECT_EQ(search.space.keys()[0].nominal, 2.5);
  EXPECT_EQ(search.space.keys()[1].nominal, 1.0);  // the scenario's default
}

TEST(SearchSpace, TellsWhatCannotBeSearched) {
  const std::string speed = "  mission.speed: {distribution: uniform, from: 1, to: 4}\n";
  EXPECT_EQ(Problems("vary:\n" + speed + "sample: {count: 4}\n"),
            "study.yaml: search: missing; the study says nothing of a search");
  EXPECT_THAT(Problems("vary:\n" + speed + "  control.distance: [1, 2]\nsearch: {}\n"),
              HasSubstr("study.yaml:7:22: vary.control.distance: a search needs a range: "
                        "{distribution: uniform, from: A, to: B}, log_uniform or integer"));
  EXPECT_THAT(Problems("vary:\n" + speed + "search: {}\nnominal: {mission.sped: 2}\n"),
              HasSubstr("study.yaml:8:25: mission.sped: is not searched: 'mission.sped'; did you "
                        "mean 'mission.speed'?"));
  EXPECT_THAT(Problems("vary:\n" + speed + "search: {}\nnominal: {mission.speed: 7}\n"),
              HasSubstr("nominal.mission.speed: the nominal value 7 is outside of the range, 1 to "
                        "4"));
  EXPECT_THAT(Problems("vary:\n" + speed + "search: {}\nnominal: {mission.speed: fast}\n"),
              HasSubstr("nominal.mission.speed: 'fast' is no number"));
  EXPECT_THAT(
      Problems(
          "vary: {disturb.payload.mass: {distribution: uniform, from: 1, to: 400}}\nsearch: {}\n"),
      HasSubstr("the scenario has no value of disturb.payload.mass to start from; give one under "
                "`nominal`"));
  EXPECT_THAT(
      Problems("vary: {mission.spede: {distribution: uniform, from: 1, to: 4}}\nsearch: {}\n"),
      HasSubstr("unknown key 'spede'; did you mean 'speed'?"));
  EXPECT_THAT(
      Problems("vary: {mission.speed: {distribution: uniform, from: 1, to: 4, step: 0.5}}\n"
               "search: {}\nnominal: {mission.speed: 2.2}\n"),
      HasSubstr("nominal.mission.speed: the nominal value 2.2 is not 1 plus a multiple of the "
                "step, 0.5; the nearest is 2"));
  EXPECT_THAT(Problems("vary:\n" + speed + "search: {method: crs}\n"),
              HasSubstr("did you mean 'crs2'?"));
}

TEST(SearchSpace, TellsWhatASearchDoesNotTake) {
  const std::string vary = "vary:\n  mission.speed: {distribution: uniform, from: 1, to: 4}\n";
  EXPECT_THAT(Problems(vary + "search: {method: random, restarts: 3}\n"),
              HasSubstr("search.restarts: random has none; leave it out"));
  EXPECT_THAT(Problems(vary + "search: {method: sobol, finish: cobyla}\n"),
              HasSubstr("search.finish: goes on from searches of NLopt, not from sobol"));
  EXPECT_THAT(Problems(vary + "search: {method: surrogate, restarts: 2}\n"),
              HasSubstr("search.restarts: surrogate has none; leave it out"));
  EXPECT_THAT(Problems(vary + "search: {method: direct, population: 30}\n"),
              HasSubstr("search.population: direct has none; leave it out"));
  EXPECT_THAT(Problems(vary + "search: {method: direct, runs: 11}\n"),
              HasSubstr("search.runs: 11 for direct and 1 keys; at least 12"));
  EXPECT_THAT(Problems(vary + "search: {method: direct, restarts: 2}\n"),
              HasSubstr("search.restarts: direct does the same each time; 1 at most"));
  EXPECT_THAT(Problems(vary + "search: 3\n"), HasSubstr("search: expected a section"));
  EXPECT_THAT(Problems(vary + "search: {runs: 1e99}\n"), HasSubstr("search.runs: "));
  EXPECT_THAT(Problems(vary + "search: {tolerance: .nan}\n"), HasSubstr("search.tolerance: "));
  EXPECT_THAT(Problems(vary + "search: {}\nnominal: [1]\n"),
              HasSubstr("nominal: expected a section of scenario keys"));
  EXPECT_THAT(Problems("vary: {mission.speed: [1, 2]}\nsearch: {}\n"),
              HasSubstr("search: no key of vary has a distribution"));
  EXPECT_THAT(Problems("vary: {mission.speed: [1, 2]}\nnominal: {mission.speed: 1}\n"),
              HasSubstr("mission.speed: is for a search; the study has no `search`"));
}

}  // namespace
}  // namespace trackbed
