#include "trackbed/world/world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "tests/vehicle/seed_car.h"

namespace trackbed {
namespace {

TEST(OutlineAt, ReachesFromTheRearBumperToTheFront) {
  const VehicleParams car = SeedCar();
  const OrientedBox outline = OutlineAt(car, {10.0, 5.0, 0.0});
  const auto corners = outline.Corners();
  EXPECT_NEAR(corners[0].x(), 10.0 + 4.45 - car.rear_overhang, Tolerance(1e-12));
  EXPECT_NEAR(corners[1].x(), 10.0 - car.rear_overhang, Tolerance(1e-12));
  EXPECT_NEAR(corners[0].y(), 5.0 + 0.5 * 1.725, Tolerance(1e-12));
}

TEST(Clearance, IsMeasuredFromTheOutlineToTheNearestObstacle) {
  const VehicleParams car = SeedCar();
  World world;
  EXPECT_FALSE(Clearance(world, car, {}).has_value());
  world.obstacles.push_back({{{30.0, 0.0, 0.0}, 2.0, 2.0}, 1.0});
  world.obstacles.push_back({{{0.0, 4.0, 0.0}, 2.0, 2.0}, 1.0});
  // To the left: 4 - 1 - half the width.
  EXPECT_NEAR(*Clearance(world, car, {}), 3.0 - 0.8625, Tolerance(1e-12));
  // Turned to face the second one, 2.7 m in front of its near side.
  EXPECT_NEAR(*Clearance(world, car, {0.0, -3.325, std::acos(-1.0) / 2.0}),
              3.0 + 3.325 - (4.45 - car.rear_overhang), Tolerance(1e-12));
  EXPECT_EQ(*Clearance(world, car, {28.0, 0.0, 0.0}), 0.0);
}

}  // namespace
}  // namespace trackbed
