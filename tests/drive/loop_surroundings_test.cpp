#include "src/drive/loop_surroundings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/track/track.h"

// Tests what controllers see of the world: known obstacles, walls, friction and track edges.
namespace trackbed {
namespace loop_surroundings_test {

Obstacle BoxAt(double x) {
  return {.footprint = {.center = {x, 0.0, 0.0}, .length = 2.0, .width = 2.0}};
}

VehicleState At(double x, double time) {
  VehicleState state;
  state.time = time;
  state.pose.x = x;
  return state;
}

TEST(LoopSurroundings, ShowObstaclesWhenTheyAreKnown) {
  const VehicleParams car = ReferenceCar();
  World world;
  world.obstacles = {BoxAt(50.0), BoxAt(60.0), BoxAt(70.0)};
  world.obstacles[0].velocity = {1.0, 0.5};
  world.obstacles[1].known_from_time = 2.0;
  world.obstacles[2].known_from_range = 10.0;
  LoopSurroundings seen(world, car);
  const Plan plan;
  seen.BeginPeriod(At(0.0, 0.0), plan);
  ASSERT_EQ(seen.Obstacles().size(), 1U);
  EXPECT_EQ(seen.Obstacles()[0].footprint.center.x, 50.0);
  seen.BeginPeriod(At(0.0, 3.0), plan);
  ASSERT_EQ(seen.Obstacles().size(), 2U);
  EXPECT_EQ(seen.Obstacles()[0].footprint.center.x, 53.0);
  EXPECT_EQ(seen.Obstacles()[0].velocity, Vec2(1.0, 0.5));
  EXPECT_EQ(seen.Obstacles()[1].footprint.center.x, 60.0);
  // The front of the car is 3.625 m ahead of its rear axle, and the box begins at 69 m.
  seen.BeginPeriod(At(69.0 - 3.625 - 9.9, 4.0), plan);
  EXPECT_EQ(seen.Obstacles().size(), 3U);
  seen.BeginPeriod(At(0.0, 5.0), plan);
  EXPECT_EQ(seen.Obstacles().size(), 3U) << "the car forgot an obstacle";
}

TEST(LoopSurroundings, ShowTheEdgesBesideThePath) {
  // The path is a circle 1 m inside of the middle of a circular track, to the left.
  constexpr double kRadius = 50.0;
  std::vector<TrackPoint> points;
  constexpr int kPoints = 200;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * kPi * i / kPoints;
    points.push_back({.position = {kRadius * std::cos(angle), kRadius * std::sin(angle)},
                      .width_right = 5.0,
                      .width_left = 4.0});
  }
  const VehicleParams car = ReferenceCar();
  const World world;
  Plan plan;
  plan.reference.path = Path({kRadius - 1.0, 0.0, 0.5 * kPi}, {{100.0, 1.0 / (kRadius - 1.0), 1}});
  LoopSurroundings seen(world, car);
  seen.BeginPeriod(At(0.0, 0.0), plan);
  EXPECT_TRUE(seen.Edges().distances.empty());
  plan.laps.track = std::make_shared<const Track>(points);
  seen.ForgetPath();
  const PathEdges& edges = seen.Edges();
  for (const double station : {0.0, 33.3, 100.0}) {
    // The sagitta of an edge between two points, which are at most 0.5 m apart, is 0.5^2/(8 45 m),
    // below 1 mm, and that of the survey, every 1.57 m, is below 1 cm.
    EXPECT_NEAR(edges.At(station).left, 3.0, Tolerance(0.011)) << station;
    EXPECT_NEAR(edges.At(station).right, 6.0, Tolerance(0.011)) << station;
  }
}

TEST(LoopSurroundings, ShowTheFrictionAtTheCar) {
  World world;
  world.friction = 0.8;
  world.friction_patches = {
      {.area = {.center = {10.0, 0.0, 0.0}, .length = 4.0, .width = 4.0}, .friction = 0.2}};
  const VehicleParams car = ReferenceCar();
  LoopSurroundings seen(world, car);
  const Plan plan;
  seen.BeginPeriod(At(0.0, 0.0), plan);
  EXPECT_EQ(seen.RoadFriction(), 0.8);
  seen.BeginPeriod(At(10.0, 1.0), plan);
  EXPECT_EQ(seen.RoadFriction(), 0.2);
}

}  // namespace loop_surroundings_test
}  // namespace trackbed
