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

}  // namespace
}  // namespace trackbed
