#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/route.h"

// Tests that routes are rejected if a stop is too close to an obstacle.
namespace trackbed {
namespace {

/// Returns a request for a route of 40 m along x, with obstacles at `boxes`. Each obstacle is 2 m x
/// 2 m.
PlanRequest RouteWith(const std::vector<Vec2>& boxes) {
  PlanRequest request{.vehicle = ReferenceCar()};
  request.waypoints = {{0.0, 0.0}, {40.0, 0.0}};
  for (const Vec2& box : boxes) {
    request.obstacles.push_back({{box.x(), box.y(), 0.0}, 2.0, 2.0});
  }
  return request;
}

Plan Check(const PlanRequest& request, double safe_distance) {
  return route::CheckStops(PlannedStops(request), request, safe_distance);
}

TEST(CheckStops, NamesTheNearestObstacleItsDistanceAndTheRequiredOne) {
  const VehicleParams car = ReferenceCar();
  const double front = car.length - car.rear_overhang;
  // The rear side of the second box is 0.25 m ahead of the front of a car at the goal.
  const Plan plan = Check(RouteWith({{0.0, 9.0}, {40.0 + front + 1.25, 0.0}}), 0.5);
  EXPECT_EQ(plan.status, PlanStatus::kGoalBlocked);
  EXPECT_EQ(plan.reason,
            fmt::format("waypoint 1 is blocked: the obstacle at ({:.4g}, 0) is 0.25 m from the "
                        "car's footprint; safe_distance is 0.5 m",
                        40.0 + front + 1.25));
  EXPECT_TRUE(Check(RouteWith({{40.0 + front + 1.25, 0.0}}), 0.25 - 1e-9).ok());
}

TEST(CheckStops, LetsTheCarLeaveAnObstacleThatItDoesNotOverlap) {
  const double front = ReferenceCar().length - ReferenceCar().rear_overhang;
  EXPECT_TRUE(Check(RouteWith({{front + 1.01, 0.0}}), 0.5).ok());
  const Plan plan = Check(RouteWith({{front + 0.99, 0.0}}), 0.5);
  EXPECT_EQ(plan.status, PlanStatus::kStartBlocked);
  EXPECT_EQ(plan.reason, fmt::format("the start is blocked: the obstacle at ({:.4g}, 0) overlaps "
                                     "the car's footprint by 0.01 m; safe_distance is 0.5 m",
                                     front + 0.99));
}

TEST(CheckStops, NamesTheDepthOfAnOverlap) {
  const double front = ReferenceCar().length - ReferenceCar().rear_overhang;
  const Plan plan = Check(RouteWith({{40.0 + front + 0.6, 0.0}}), 0.3);
  EXPECT_EQ(plan.status, PlanStatus::kGoalBlocked);
  EXPECT_EQ(plan.reason,
            fmt::format("waypoint 1 is blocked: the obstacle at ({:.4g}, 0) overlaps the car's "
                        "footprint by 0.4 m; safe_distance is 0.3 m",
                        40.0 + front + 0.6));
}

/// Returns whether a car that keeps `safe_distance` may be clear of the obstacles at its goal.
bool MayReachGoal(const PlanRequest& request, double safe_distance) {
  const CollisionChecker clear = route::CheckerFromStart(request, safe_distance);
  return route::GoalsOutsideObstacles(request, clear).size() == 1;
}

// The circle inside the car has a radius of 0.8 m, half its width. The first box is beside the
// start, so the car may leave it.
TEST(GoalBlocked, NamesTheObstacleAndRemediesThatFit) {
  PlanRequest request = RouteWith({{0.0, 2.0}, {42.1004, 0.0}});
  request.vehicle.width = 1.6;
  ASSERT_FALSE(MayReachGoal(request, 0.5));
  EXPECT_EQ(route::GoalBlocked(request, 1, 0.5).status, PlanStatus::kGoalBlocked);
  EXPECT_EQ(
      route::GoalBlocked(request, 1, 0.5).reason,
      "waypoint 1 is blocked: the obstacle at (42.1, 0) is 1.1 m away; the rear axle's center "
      "must be at least 1.3 m away, 0.8 m of them for the car; set safe_distance to at most "
      "0.3 m, or move the waypoint away from the obstacle by 0.2 m");
  EXPECT_TRUE(MayReachGoal(request, 0.3));
  request.waypoints[1].x() -= 0.2;
  EXPECT_TRUE(MayReachGoal(request, 0.5));
}

TEST(GoalBlocked, NamesNoSafeDistanceIfTheCarWouldHitTheObstacle) {
  PlanRequest request = RouteWith({{40.4004, 0.0}});
  request.vehicle.width = 1.6;
  ASSERT_FALSE(MayReachGoal(request, 0.0));
  EXPECT_EQ(route::GoalBlocked(request, 1, 0.5).reason,
            "waypoint 1 is blocked: the obstacle at (40.4, 0) covers it, 0.6 m from the edge; the "
            "rear axle's center must be at least 1.3 m away, 0.8 m of them for the car; move the "
            "waypoint away from the obstacle by 1.9 m");
  request.waypoints[1].x() -= 1.9;
  EXPECT_TRUE(MayReachGoal(request, 0.5));
}

}  // namespace
}  // namespace trackbed
