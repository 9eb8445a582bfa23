// Tests that rounded polylines pass their waypoints as closely as the limits require.

#include "trackbed/planning/common/turn_behind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/planning/routes.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/corners.h"

namespace trackbed {
namespace {

using ::testing::HasSubstr;

CornerLimits Limits(const std::vector<Vec2>& route, double max_gap) {
  return {.speed = 3.0,
          .min_speed = 0.5,
          .max_curvature = 1.0 / 5.1,
          .waypoints = route,
          .max_gap = max_gap};
}

const CollisionChecker& NothingAround() {
  static const CollisionChecker clear(ReferenceCar(), {}, 0.0);
  return clear;
}

/// Half of the distance between samples [m]. SampledDistance exceeds the true distance by at most
/// this value.
constexpr double kHalfSample = 0.05;

/// Returns the smallest distance [m] from a point to the samples of a path.
double SampledDistance(const Path& path, const Vec2& point) {
  double nearest = 1e9;
  for (const PathPoint& sample : path.Sample(2.0 * kHalfSample)) {
    nearest = std::min(nearest, (sample.pose.position() - point).norm());
  }
  return nearest;
}

TEST(CornerAt, HasTheGapOfItsCurve) {
  for (const double h : {0.3, -1.5, 2.5}) {
    for (const double speed : {0.5, 3.0}) {
      const Vec2 corner{200.0, 0.0};
      const std::vector<Vec2> route{{0, 0}, corner, corner + 200.0 * Direction(h)};
      CornerLimits limits = Limits({}, 0.0);
      limits.speed = limits.min_speed = speed;
      const RoundedCorners rounded = RoundCorners(ReferenceCar(), route, limits, NothingAround());
      ASSERT_EQ(rounded.status, PlanStatus::kOk) << rounded.reason;
      EXPECT_NEAR(rounded.corners[0].gap, SampledDistance(rounded.path, corner),
                  Tolerance(kHalfSample));
    }
  }
}

TEST(RoundCorners, SlowsDownToPassNearAWaypoint) {
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {60, 60}};
  const auto rounded = [&](double max_gap) {
    return RoundCorners(ReferenceCar(), route, Limits(route, max_gap), NothingAround());
  };
  const RoundedCorners free = rounded(100.0);
  EXPECT_EQ(free.corners[0].speed, 3.0);
  // The bound `gap` is the mean of the gaps at 3 m/s and at 0.5 m/s. Bisection finds the speed to
  // 1e-6 m/s. The gap grows by less than 10 m for each m/s, so the gap at the found speed is at
  // most 1e-5 m below the bound.
  const double gap =
      0.5 * (free.corners[0].gap + CornerAt(ReferenceCar(), 0.5 * kPi, 0.5, 1.0 / 5.1).gap);
  const RoundedCorners near = rounded(gap);
  ASSERT_EQ(near.status, PlanStatus::kOk) << near.reason;
  EXPECT_LE(near.corners[0].gap, gap);
  EXPECT_NEAR(near.corners[0].gap, gap, Tolerance(1e-5));
  EXPECT_LT(near.corners[0].speed, 3.0);
}

TEST(RoundCorners, NamesTheWaypointThatItMisses) {
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {60, 60}};
  const RoundedCorners rounded =
      RoundCorners(ReferenceCar(), route, Limits(route, 1.0), NothingAround());
  EXPECT_EQ(rounded.status, PlanStatus::kWaypointMissed);
  EXPECT_EQ(rounded.sharp_corner, 1U);
  EXPECT_THAT(rounded.reason, HasSubstr("waypoint 1 at (60, 0) is missed by "));
  EXPECT_THAT(rounded.reason, HasSubstr("more than 1 m"));
}

TEST(RoundCornersOrTurnBehind, PassesEveryWaypointOfSharpRoutes) {
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    // A turn behind a waypoint needs less than 30 m of a leg. Legs of at least 60 m therefore have
    // room for turns at both ends.
    std::vector<Vec2> route = RandomRoute(random, 5, 60.0, 120.0, kPi);
    if (i % 4 == 0) {
      route.resize(3);
      route[2] = route[0];  // The route returns to its start along the same line.
    }
    const double max_gap = random.Uniform(0.0, 5.0);
    const RoundedCorners rounded =
        RoundCornersOrTurnBehind(ReferenceCar(), route, Limits(route, max_gap), NothingAround());
    ASSERT_EQ(rounded.status, PlanStatus::kOk) << i << ": " << rounded.reason;
    for (std::size_t k = 1; k < route.size(); ++k) {
      EXPECT_LE(SampledDistance(rounded.path, route[k]), max_gap + Tolerance(kHalfSample)) << i;
    }
    // The tolerance allows for rounding over some hundred meters.
    const Vec2 end = rounded.path.At(rounded.path.length()).pose.position();
    EXPECT_NEAR((end - route.back()).norm(), 0.0, Tolerance(1e-8));
  }
}

/// Points on an arc to the left, `spacing` [m] apart.
std::vector<Vec2> PointsOnArc(double radius, double spacing, std::size_t count) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = static_cast<double>(i) * spacing / radius;
    points.emplace_back(radius * std::sin(angle), radius * (1.0 - std::cos(angle)));
  }
  return points;
}

TEST(RoundCornersOrTurnBehind, FollowsABendOfClosePoints) {
  Random random(2);
  for (int i = 0; i < 60; ++i) {
    const double radius = random.Uniform(12.0, 60.0);
    const auto count = static_cast<std::size_t>(random.Uniform(4.0, 12.0));
    // The route is at least 5 m long, because even the slowest curve of a gentle corner needs a
    // meter or two of each leg.
    const double spacing = random.Uniform(5.0 / static_cast<double>(count - 1), 5.0);
    const std::vector<Vec2> route = PointsOnArc(radius, spacing, count);
    CornerLimits limits = Limits(route, 4.5);
    limits.deceleration = 1.5;
    // The car needs 3 m to slow down from 3 m/s, and some meters to turn.
    const double length = spacing * static_cast<double>(count - 1);
    limits.start_speed = length > 15.0 && i % 2 == 0 ? 3.0 : 0.0;
    const RoundedCorners rounded =
        RoundCornersOrTurnBehind(ReferenceCar(), route, limits, NothingAround());
    ASSERT_EQ(rounded.status, PlanStatus::kOk) << i << ": " << rounded.reason;
    for (const Vec2& point : route) {
      EXPECT_LE(SampledDistance(rounded.path, point), limits.max_gap + Tolerance(kHalfSample)) << i;
    }
    // A path with a turn behind a waypoint is longer by at least a full circle.
    EXPECT_LT(rounded.path.length(), length + 2.0 * kPi / limits.max_curvature)
        << i << ": " << count << " points " << spacing << " m apart, radius " << radius;
  }
}

TEST(RoundCornersOrTurnBehind, LeavesOutNoWaypointBeyondTheBound) {
  // Without a detour, the path passes the second waypoint at a distance of 3 m, so only a bound
  // below 3 m needs a detour.
  const std::vector<Vec2> route{{0, 0}, {30, 0}, {33, 3}, {36, 0}, {66, 0}};
  for (const double max_gap : {1.0, 4.0}) {
    const RoundedCorners rounded =
        RoundCornersOrTurnBehind(ReferenceCar(), route, Limits(route, max_gap), NothingAround());
    ASSERT_EQ(rounded.status, PlanStatus::kOk) << rounded.reason;
    for (const Vec2& point : route) {
      EXPECT_LE(SampledDistance(rounded.path, point), max_gap + Tolerance(kHalfSample));
    }
  }
}

TEST(RoundCornersOrTurnBehind, TurnsToTheSideThatIsFree) {
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {0, 20}};
  for (const double side : {1.0, -1.0}) {
    const CollisionChecker clear(ReferenceCar(), {{{72.0, 12.0 * side, 0.0}, 4.0, 10.0}}, 0.2);
    const RoundedCorners rounded =
        RoundCornersOrTurnBehind(ReferenceCar(), route, Limits(route, 1.0), clear);
    ASSERT_EQ(rounded.status, PlanStatus::kOk) << rounded.reason;
    EXPECT_FALSE(clear.FirstBlocked(rounded.path));
    EXPECT_LE(SampledDistance(rounded.path, route[1]), 1.0 + Tolerance(kHalfSample));
  }
}

TEST(RoundCornersOrTurnBehind, SaysWhatWasMissingBeforeAWall) {
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {0, 20}};
  const CollisionChecker wall(ReferenceCar(), {{{66.0, 0.0, 0.0}, 2.0, 100.0}}, 0.2);
  const RoundedCorners rounded =
      RoundCornersOrTurnBehind(ReferenceCar(), route, Limits(route, 4.0), wall);
  EXPECT_EQ(rounded.status, PlanStatus::kWaypointMissed);
  EXPECT_THAT(rounded.reason, HasSubstr("waypoint 1 at (60, 0) is missed by "));
  EXPECT_THAT(rounded.reason, HasSubstr("no room for a turn behind the waypoint"));
}

TEST(RoundCornersOrTurnBehind, IsRoundCornersWithoutABound) {
  const std::vector<Vec2> route{{0, 0}, {60, 0}, {0, 20}};
  const CornerLimits limits{.speed = 3.0, .min_speed = 0.5, .max_curvature = 1.0 / 5.1};
  EXPECT_EQ(
      RoundCornersOrTurnBehind(ReferenceCar(), route, limits, NothingAround()).path.segments(),
      RoundCorners(ReferenceCar(), route, limits, NothingAround()).path.segments());
}

TEST(RoundCornersOrTurnBehind, TurnsOnTheFirstLegToASecondClick) {
  // The goal is 0.36 m from the first waypoint, at which no corner fits. The turn is on the first
  // leg, up to the heading atan(0.2/10.3) at least. The line from the start to the goal passes the
  // waypoint at 10 sin of this heading, 0.194 m, and a later turn passes it nearer.
  const std::vector<Vec2> route{{0, 0}, {10, 0}, {10.3, 0.2}};
  const RoundedCorners rounded =
      RoundCornersOrTurnBehind(ReferenceCar(), route, Limits(route, 4.5), NothingAround());
  ASSERT_EQ(rounded.status, PlanStatus::kOk) << rounded.reason;
  // The path is at least as long as the line to the goal, and at most as long as the polyline.
  EXPECT_LE(rounded.path.length(), 10.0 + std::hypot(0.3, 0.2));
  EXPECT_GE(rounded.path.length(), std::hypot(10.3, 0.2));
  EXPECT_LE(SampledDistance(rounded.path, route[1]),
            10.0 * 0.2 / std::hypot(10.3, 0.2) + Tolerance(kHalfSample));
}

}  // namespace
}  // namespace trackbed
