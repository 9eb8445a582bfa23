#include "src/falsify/point_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "src/falsify/search_loop.h"

namespace trackbed {
namespace {

SearchSpace Square() {
  return SearchSpace({{.key = "x", .nominal = 0.2}, {.key = "y", .nominal = 0.9}});
}

struct Course {
  std::vector<UnitPoint> points;
  double least = std::numeric_limits<double>::infinity();
  std::size_t largest_batch = 0;
};

/// Runs a search to its end, or stops it after some batches.
Course Follow(const SearchSpec& spec, std::size_t batches = 100000) {
  const SearchSpace space = Square();
  const auto search = MakePointSearch(spec, space, std::nullopt);
  Course course;
  for (std::size_t i = 0; i < batches; ++i) {
    const std::vector<UnitPoint> batch = search->Ask();
    if (batch.empty()) {
      break;
    }
    course.largest_batch = std::max(course.largest_batch, batch.size());
    std::vector<std::optional<double>> values;
    for (const UnitPoint& point : batch) {
      course.points.push_back(point);
      if (point[0] > 0.95) {
        values.emplace_back();  // a point without a value
        continue;
      }
      values.emplace_back(std::pow(point[0] - 0.63, 2) + std::pow(point[1] - 0.31, 2));
      course.least = std::min(course.least, *values.back());
    }
    search->Tell(values);
  }
  return course;
}

SearchSpec Spec(const std::string& method, int runs) {
  SearchSpec spec;
  spec.method = method;
  spec.runs = runs;
  return spec;
}

class EverySearch : public testing::TestWithParam<std::string> {};

TEST_P(EverySearch, KeepsItsRunsAndTheSquare) {
  for (const int runs : {20, 21, 160}) {
    const Course course = Follow(Spec(GetParam(), runs));
    EXPECT_LE(course.points.size(), static_cast<std::size_t>(runs));
    EXPECT_GE(course.points.size(), static_cast<std::size_t>(runs) / 2);
    for (const UnitPoint& point : course.points) {
      ASSERT_EQ(point.size(), 2U);
      EXPECT_GE(std::min(point[0], point[1]), 0.0);
      EXPECT_LE(std::max(point[0], point[1]), 1.0);
    }
    // The value of the best point is its squared distance from the minimum. The best value must be
    // below the squared radius of a disk with a quarter of the square's area.
    EXPECT_LT(course.least, 1.0 / (3.141592653589793 * 4.0));
  }
}

TEST_P(EverySearch, ProposesTheSameEachTime) {
  EXPECT_EQ(Follow(Spec(GetParam(), 60)).points, Follow(Spec(GetParam(), 60)).points);
}

TEST_P(EverySearch, CanBeStopped) {
  for (const std::size_t batches : {0U, 1U, 3U}) {
    EXPECT_LE(Follow(Spec(GetParam(), 200), batches).points.size(), batches * 8);
  }
}

INSTANTIATE_TEST_SUITE_P(PointSearch, EverySearch, testing::ValuesIn(StudySearches()),
                         [](const auto& one) { return one.param; });

TEST(PointSearch, RunsRestartsSideBySide) {
  SearchSpec spec = Spec("crs2", 90);
  spec.restarts = 5;
  const Course course = Follow(spec);
  EXPECT_EQ(course.largest_batch, 5U);
  EXPECT_EQ(course.points.size(), 90U);
  // The first point is the nominal point.
  EXPECT_EQ(course.points.front(), Square().nominal());
}

TEST(PointSearch, FinishesFromTheBestPoint) {
  SearchSpec spec = Spec("crs2", 120);
  spec.restarts = 1;
  spec.finish = "nelder_mead";
  const std::vector<UnitPoint> points = Follow(spec).points;
  const auto miss = [](const UnitPoint& p) {
    return p[0] > 0.95 ? 9.0 : std::pow(p[0] - 0.63, 2) + std::pow(p[1] - 0.31, 2);
  };
  ASSERT_GT(points.size(), 90U);  // the last quarter of the runs is the final local search
  const auto best =
      std::min_element(points.begin(), points.begin() + 90,
                       [&](const UnitPoint& a, const UnitPoint& b) { return miss(a) < miss(b); });
  EXPECT_EQ(points[90], *best);
}

TEST(PointSearch, SeedsDiffer) {
  for (const std::string method :
       {"random", "latin_hypercube", "sobol", "surrogate", "crs2", "esch", "isres"}) {
    SearchSpec spec = Spec(method, 40);
    const Course first = Follow(spec);
    spec.seed = 2;
    EXPECT_NE(Follow(spec).points, first.points) << method;
  }
}

TEST(PointSearch, TakesAllStepsAlike) {
  const SearchSpace space(
      {{.key = "x", .from = 2.0, .to = 4.5, .step = 0.5, .nominal = 2.0},
       {.key = "n", .kind = DistributionKind::kInteger, .from = 1.0, .to = 6.0, .nominal = 1.0}});
  const SearchSpec spec = Spec("latin_hypercube", 600);
  const auto search = MakePointSearch(spec, space, std::nullopt);
  std::map<double, int> steps;
  std::map<double, int> numbers;
  FollowSearch(*search, space, [&](const std::vector<UnitPoint>& points) {
    for (const UnitPoint& point : points) {
      ++steps[space.Value(0, point[0])];
      ++numbers[space.Value(1, point[1])];
    }
    return std::optional(std::vector<std::optional<double>>(points.size()));
  });
  // Each of the six values has 100 of the 600 strata of a Latin hypercube.
  const std::map<double, int> expected_steps{{2.0, 100}, {2.5, 100}, {3.0, 100},
                                             {3.5, 100}, {4.0, 100}, {4.5, 100}};
  EXPECT_EQ(steps, expected_steps);
  const std::map<double, int> expected_numbers{{1.0, 100}, {2.0, 100}, {3.0, 100},
                                               {4.0, 100}, {5.0, 100}, {6.0, 100}};
  EXPECT_EQ(numbers, expected_numbers);
}

SearchSpace Steps() {
  return SearchSpace({{.key = "x", .from = 0.0, .to = 10.0, .step = 1.0, .nominal = 2.0},
                      {.key = "y", .from = 0.0, .to = 10.0, .step = 1.0, .nominal = 9.0}});
}

TEST(SurrogateSearch, ProposesNoPointTwice) {
  const SearchSpace space = Steps();
  for (const bool stop : {true, false}) {
    SearchSpec spec = Spec("surrogate", 500);
    spec.stop = stop;
    const auto search = MakePointSearch(spec, space, 0.7);
    std::set<UnitPoint> all{space.nominal()};
    FollowSearch(*search, space, [&](const std::vector<UnitPoint>& points) {
      std::optional<std::vector<std::optional<double>>> values(std::in_place);
      for (const UnitPoint& point : points) {
        EXPECT_TRUE(all.insert(point).second) << point[0] << " " << point[1];
        // Half of the points are not valid scenarios.
        values->push_back(std::lround(10.0 * (point[0] + point[1])) % 2 == 0
                              ? std::optional(point[0] - 0.3)
                              : std::nullopt);
      }
      return values;
    });
    EXPECT_EQ(all.size(), 121U);  // the search has used all points
  }
}

/// The robustness is 0.5, except for a wide basin with a large violation and a narrow basin with a
/// small violation.
double TwoBasins(const UnitPoint& at) {
  const auto basin = [&](double x, double y, double width) {
    return std::exp(-0.5 * (std::pow(at[0] - x, 2) + std::pow(at[1] - y, 2)) / (width * width));
  };
  return 0.5 - 1.2 * basin(0.25, 0.7, 0.12) - 0.62 * basin(0.8, 0.2, 0.08);
}

TEST(SurrogateSearch, GoesOnToOtherRegionsThatFail) {
  const SearchSpace space({{.key = "x", .from = 0.0, .to = 30.0, .step = 1.0, .nominal = 15.0},
                           {.key = "y", .from = 0.0, .to = 30.0, .step = 1.0, .nominal = 30.0}});
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SearchSpec spec = Spec("surrogate", 96);  // a tenth of all points
    spec.stop = false;
    spec.seed = seed;
    const auto search = MakePointSearch(spec, space, TwoBasins(space.nominal()));
    int wide = 0;
    int narrow = 0;
    FollowSearch(*search, space, [&](const std::vector<UnitPoint>& points) {
      std::optional<std::vector<std::optional<double>>> values(std::in_place);
      for (const UnitPoint& point : points) {
        values->push_back(TwoBasins(point));
        (point[0] < 0.5 ? wide : narrow) += *values->back() < 0.0 ? 1 : 0;
      }
      return values;
    });
    EXPECT_GT(wide, 0) << seed;
    EXPECT_GT(narrow, 0) << seed;
    // A fair share of points remains for the rest of the square.
    EXPECT_LT(wide + narrow, 96 / 2) << seed;
  }
}

TEST(FollowSearch, RoundsPointsAndEndsWhenItsRunsDo) {
  const SearchSpace space = Steps();
  const SearchSpec spec = Spec("sobol", 100);
  const auto search = MakePointSearch(spec, space, std::nullopt);
  int batches = 0;
  FollowSearch(*search, space,
               [&](const std::vector<UnitPoint>& points)
                   -> std::optional<std::vector<std::optional<double>>> {
                 for (const UnitPoint& point : points) {
                   EXPECT_EQ(space.Snap(point), point);
                 }
                 if (++batches == 3) {
                   return std::nullopt;
                 }
                 return std::vector<std::optional<double>>(points.size(), 1.0);
               });
  EXPECT_EQ(batches, 3);
}

}  // namespace
}  // namespace trackbed
