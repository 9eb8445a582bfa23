#include "trackbed/world/world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"

namespace trackbed {
namespace {

TEST(FootprintAt, ReachesFromTheRearBumperToTheFront) {
  const VehicleParams car = ReferenceCar();
  const OrientedBox footprint = FootprintAt(car, {10.0, 5.0, 0.0});
  const auto corners = footprint.Corners();
  EXPECT_NEAR(corners[0].x(), 10.0 + 4.45 - car.rear_overhang, Tolerance(1e-12));
  EXPECT_NEAR(corners[1].x(), 10.0 - car.rear_overhang, Tolerance(1e-12));
  EXPECT_NEAR(corners[0].y(), 5.0 + 0.5 * 1.725, Tolerance(1e-12));
}

TEST(Clearance, IsMeasuredFromTheFootprintToTheNearestObstacle) {
  const VehicleParams car = ReferenceCar();
  World world;
  EXPECT_FALSE(Clearance(world, car, {}, 0.0).has_value());
  world.obstacles.push_back({{{30.0, 0.0, 0.0}, 2.0, 2.0}, 1.0});
  world.obstacles.push_back({{{0.0, 4.0, 0.0}, 2.0, 2.0}, 1.0});
  // The second obstacle is on the left: its near side is at y = 4 m - 1 m = 3 m, and half the car's
  // width is 0.8625 m.
  EXPECT_NEAR(*Clearance(world, car, {}, 0.0), 3.0 - 0.8625, Tolerance(1e-12));
  // The car faces the second obstacle, whose near side is 2.7 m in front of the car.
  EXPECT_NEAR(*Clearance(world, car, {0.0, -3.325, std::acos(-1.0) / 2.0}, 0.0),
              3.0 + 3.325 - (4.45 - car.rear_overhang), Tolerance(1e-12));
  EXPECT_EQ(*Clearance(world, car, {28.0, 0.0, 0.0}, 0.0), 0.0);
}

TEST(Obstacles, MoveOnWithoutTurning) {
  const VehicleParams car = ReferenceCar();
  World world;
  world.obstacles.push_back({.footprint = {{30.0, 2.0, 0.5}, 4.0, 2.0}, .velocity = {-3.0, 0.5}});
  const OrientedBox later = FootprintAt(world.obstacles[0], 4.0);
  EXPECT_EQ(later.center.x, 18.0);
  EXPECT_EQ(later.center.y, 4.0);
  EXPECT_EQ(later.center.yaw, 0.5);
  EXPECT_EQ(*Clearance(world, car, {}, 4.0), Distance(FootprintAt(car, {}), later));
  EXPECT_EQ(*Clearance(world, car, {}, 0.0),
            Distance(FootprintAt(car, {}), world.obstacles[0].footprint));
}

TEST(Obstacles, AreSeenWhereTheyAreByThen) {
  const VehicleParams car = ReferenceCar();
  const Obstacle obstacle{
      .footprint = {{40.0, 0.0, 0.0}, 4.0, 2.0}, .known_from_range = 10.0, .velocity = {-5.0, 0.0}};
  // At time t the distance from the front bumper to the obstacle's near side is 38 - front - 5 t.
  const double front = car.length - car.rear_overhang;
  const double seen = (38.0 - front - 10.0) / 5.0;
  EXPECT_FALSE(IsKnown(obstacle, seen - 1e-6, FootprintAt(car, {})));
  EXPECT_TRUE(IsKnown(obstacle, seen + 1e-6, FootprintAt(car, {})));
}

}  // namespace
}  // namespace trackbed
