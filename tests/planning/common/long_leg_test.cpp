#include "trackbed/planning/common/long_leg.h"

#include <gtest/gtest.h>

#include <numbers>

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

}  // namespace
}  // namespace trackbed
