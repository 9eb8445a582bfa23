#include "src/falsify/point_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Lets a search go to its end, or stops it after some batches.
Course Follow(const SearchSpec& spec, std::size_t batches = 100000) {
  const SearchSpace space = Square();
  const auto search = MakePointSearch(spec, space);
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
    // Closer than the mean nearest of as few points in a square: a ball of 1/20 of its area.
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
  // The first begins at the nominal point.
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
  ASSERT_GT(points.size(), 90U);  // the last quarter is of the finish
  const auto best =
      std::min_element(points.begin(), points.begin() + 90,
                       [&](const UnitPoint& a, const UnitPoint& b) { return miss(a) < miss(b); });
  EXPECT_EQ(points[90], *best);
}

TEST(PointSearch, SeedsDiffer) {
  for (const std::string method : {"random", "latin_hypercube", "sobol", "crs2", "esch", "isres"}) {
    SearchSpec spec = Spec(method, 40);
    const Course first = Follow(spec);
    spec.seed = 2;
    EXPECT_NE(Follow(spec).points, first.points) << method;
  }
}

}  // namespace
}  // namespace trackbed
