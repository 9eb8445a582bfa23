#include "trackbed/planning/common/long_leg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/tolerance.h"

namespace trackbed {
namespace {

constexpr double kCircle = 20.0 * std::numbers::pi;  // length of a circle with the radius 10 m

TEST(LongestLeg, IsTheOneWithALoop) {
  // 30 m straight, a whole circle, and 20 m straight: the loop lies between the points at 10 m and
  // 40 m, whose distance along the path is 30 m plus the circle. The lengths are multiples of a
  // sixteenth of the excess, and each end of a leg may be one spacing away.
  const Path path({}, {{.length = 30.0}, {.length = kCircle, .curvature = 0.1}, {.length = 20.0}});
  const auto leg = LongestLeg(path, {{0, 0}, {10, 0}, {40, 0}, {50, 0}}, 0.5 * kCircle);
  ASSERT_TRUE(leg.has_value());
  EXPECT_EQ(leg->to, 2U);
  EXPECT_EQ(leg->straight, 30.0);
  EXPECT_NEAR(leg->length, 30.0 + kCircle, Tolerance(kCircle / 16.0));
}

TEST(LongestLeg, IsNoneWithoutALoop) {
  // A right angle with the radius 10 m is shorter than the lines through its corner.
  const Path path(
      {}, {{.length = 20.0}, {.length = 0.25 * kCircle, .curvature = 0.1}, {.length = 20.0}});
  EXPECT_FALSE(LongestLeg(path, {{0, 0}, {30, 0}, {30, 30}}, 0.1));
  EXPECT_FALSE(LongestLeg(path, {{0, 0}}, 0.1));
}

TEST(LongestLeg, KeepsTheOrderOfARouteThatIsDrivenTwice) {
  // Two rounds of one circle through four waypoints: each leg is a quarter of the circle, 15.7 m
  // instead of 14.1 m, although each waypoint is passed twice or three times.
  const Path path({}, {{.length = 2.0 * kCircle, .curvature = 0.1}});
  std::vector<Vec2> twice{{0, 0}};
  for (int round = 0; round < 2; ++round) {
    for (const Vec2& at : {Vec2(10, 10), Vec2(0, 20), Vec2(-10, 10), Vec2(0, 0)}) {
      twice.push_back(at);
    }
  }
  EXPECT_FALSE(LongestLeg(path, twice, 5.0));
  // Without the waypoints of the second round, that round is the last leg.
  const auto leg = LongestLeg(path, {{0, 0}, {10, 10}, {0, 20}, {-10, 10}, {0, 0}}, 5.0);
  ASSERT_TRUE(leg.has_value());
  EXPECT_EQ(leg->to, 4U);
}

/// Returns the longest leg by trying all samples for all waypoints, with a table of all sums.
double LongestExtraByTable(const Path& path, const std::vector<Vec2>& waypoints, double spacing) {
  const std::vector<PathPoint> samples = path.Sample(spacing);
  const std::size_t goal = waypoints.size() - 1;
  std::vector<std::vector<double>> sums(goal, std::vector<double>(samples.size(), 0.0));
  std::vector<std::vector<std::size_t>> at(goal, std::vector<std::size_t>(samples.size(), 0));
  for (std::size_t i = 1; i < goal; ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const double sum = sums[i - 1][k] + (samples[k].pose.position() - waypoints[i]).norm();
      at[i][k] = sum < least ? k : at[i][k - 1];
      least = std::min(least, sum);
      sums[i][k] = least;
    }
  }
  double most = 0.0;
  std::size_t end = samples.size() - 1;
  for (std::size_t i = goal; i > 0; --i) {
    const std::size_t start = i > 1 ? at[i - 1][end] : 0;
    const double straight = (waypoints[i] - waypoints[i - 1]).norm();
    most = std::max(most, samples[end].s - samples[start].s - straight);
    end = start;
  }
  return most;
}

TEST(LongestLeg, IsThatOfATableOfAllSums) {
  // Routes of random arcs, whose waypoints lie up to 1 m beside the path.
  std::mt19937 random(47);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Segment> segments;
    for (int i = 0; i < 8; ++i) {
      segments.push_back({.length = 20.0 + 15.0 * share(random), .curvature = 0.2 * share(random)});
    }
    const Path path({}, segments);
    std::vector<Vec2> waypoints{{0, 0}};
    double station = 0.0;
    for (const Segment& segment : segments) {
      station += segment.length;
      waypoints.push_back(path.At(station).pose.position() + Vec2(share(random), share(random)));
    }
    waypoints.back() = path.At(path.length()).pose.position();
    const double excess = 3.0;
    const auto leg = LongestLeg(path, waypoints, excess);
    const double most = LongestExtraByTable(path, waypoints, excess / 16.0);
    ASSERT_EQ(leg.has_value(), most >= excess) << trial;
    if (leg) {
      EXPECT_NEAR(leg->length - leg->straight, most, Tolerance(1e-9)) << trial;
    }
  }
}

}  // namespace
}  // namespace trackbed
