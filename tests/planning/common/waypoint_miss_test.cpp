#include "trackbed/planning/common/waypoint_miss.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

/// Returns a path of 10 m straight, followed by a quarter circle to the left around (10, 10).
Path LineAndArc() {
  return {{}, {{.length = 10.0}, {.length = 5.0 * std::numbers::pi, .curvature = 0.1}}};
}

TEST(LargestWaypointMiss, IsTheDistanceFromALineOrAnArc) {
  const auto miss = LargestWaypointMiss(LineAndArc(), {{0, 50}, {5, 3}, {20, 0}, {20, 10}});
  ASSERT_TRUE(miss.has_value());
  EXPECT_EQ(miss->waypoint, 2U);
  EXPECT_EQ(miss->at, Vec2(20, 0));
  // The point (20, 0) lies on a diagonal through the center of the arc. The tolerance allows for
  // rounding of a few operations.
  EXPECT_NEAR(miss->distance, 10.0 * (std::numbers::sqrt2 - 1.0), Tolerance(1e-12));
  EXPECT_NEAR(miss->station, 10.0 + 2.5 * std::numbers::pi, Tolerance(1e-12));
}

TEST(LargestWaypointMiss, DoesNotExtendThePathBeyondItsEnds) {
  EXPECT_NEAR(LargestWaypointMiss(LineAndArc(), {{0, 0}, {20, 16}})->distance, 6.0,
              Tolerance(1e-12));
  EXPECT_NEAR(LargestWaypointMiss(LineAndArc(), {{0, 0}, {-3, 4}})->distance, 5.0,
              Tolerance(1e-12));
}

TEST(LargestWaypointMiss, SkipsTheStartOfTheRoute) {
  EXPECT_FALSE(LargestWaypointMiss(LineAndArc(), {}).has_value());
  EXPECT_FALSE(LargestWaypointMiss(LineAndArc(), {{30, 30}}).has_value());
}

TEST(LargestWaypointMiss, IsThatOfADenseSampleOfClothoids) {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    std::vector<Segment> segments;
    for (int k = 0; k < 4 + 3 * i; ++k) {
      segments.push_back({.length = random.Uniform(2.0, 10.0),
                          .curvature = random.Uniform(-0.1, 0.1),
                          .direction = 1,
                          .sharpness = random.Uniform(-0.02, 0.02)});
    }
    const Path path({}, segments);
    const Vec2 waypoint{random.Uniform(-10.0, 30.0), random.Uniform(-20.0, 20.0)};
    double nearest = 1e9;
    for (const PathPoint& point : path.Sample(0.01)) {
      nearest = std::min(nearest, (point.pose.position() - waypoint).norm());
    }
    // The nearest sample is at most half of the spacing away from the nearest point of the path.
    EXPECT_NEAR(LargestWaypointMiss(path, {{0, 0}, waypoint})->distance, nearest, Tolerance(0.005));
  }
}

TEST(RemedyForMiss, RoundsUp) {
  EXPECT_EQ(RemedyForMiss(24.31),
            "set plan.max_waypoint_miss to at least 24.4, or move the waypoint");
  EXPECT_EQ(RemedyForMiss(0.0),
            "set plan.max_waypoint_miss to at least 0.001, or move the waypoint");
  EXPECT_EQ(RemedyForMiss(1234.5),
            "set plan.max_waypoint_miss to at least 1240, or move the waypoint");
}

}  // namespace
}  // namespace trackbed
