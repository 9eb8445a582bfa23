#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/world_scene.h"

// Tests Plant::ApplyLateralOffset and Plant::ApplyLateralForce.
namespace trackbed {
namespace kick_test {

const CarModel& Prius() {
  static const CarModel car(ComposeScene(FindModel("prius", ""), {}), "prius");
  return car;
}

TEST(ApplyLateralOffset, SetsEveryPlantAside) {
  const World world;
  for (const PlantEntry& entry : Plants()) {
    const auto plant = MakePlant(
        entry.name,
        {.car = Prius(), .world = world, .start = {.pose = {5.0, 3.0, 0.7}, .speed = 4.0}});
    plant->ApplyLateralOffset(0.5);
    const VehicleState state = plant->Observe();
    EXPECT_NEAR(state.pose.x, 5.0 - 0.5 * std::sin(0.7), Tolerance(1e-14)) << entry.name;
    EXPECT_NEAR(state.pose.y, 3.0 + 0.5 * std::cos(0.7), Tolerance(1e-14)) << entry.name;
    EXPECT_EQ(state.pose.yaw, 0.7) << entry.name;
    EXPECT_NEAR(state.speed, 4.0, Tolerance(1e-14)) << entry.name;
    EXPECT_EQ(state.distance, 0.0) << entry.name;
    for (int i = 0; i < 500; ++i) {
      plant->Step({});
    }
    // The car continues straight and parallel to its old line.
    const Pose2 pose = plant->Observe().pose;
    EXPECT_NEAR(ToLocal({5.0, 3.0, 0.7}, pose.position()).y(), 0.5, Tolerance(1e-4)) << entry.name;
    EXPECT_FALSE(plant->diverged()) << entry.name;
  }
}

TEST(ApplyLateralOffset, GoesUpWithTheGround) {
  World world;
  world.ground.grade = {0.0, 0.1};
  const CarModel car(WithWorld(Prius().scene(), Prius().params(), world), "prius");
  const auto plant = MakePlant("mujoco", {.car = car, .world = world, .start = {}});
  const double before = plant->Configuration()[2];
  plant->ApplyLateralOffset(2.0);
  EXPECT_NEAR(plant->Configuration()[2] - before, 0.2, Tolerance(1e-14));
}

/// On ice there are no other lateral forces, so the impulse equals the car's momentum.
TEST(ApplyLateralForce, GivesMujocosCarTheMomentum) {
  const World ice{.friction = 1e-5};
  const auto plant = MakePlant(
      "mujoco",
      {.car = Prius(), .world = ice, .start = {.pose = {0.0, 0.0, kPi / 3.0}, .speed = 5.0}});
  for (int i = 0; i < 50; ++i) {
    plant->ApplyLateralForce(4000.0);
    plant->Step({});
  }
  const VehicleState state = plant->Observe();
  // The impulse is 4000 N * 0.1 s = 400 N s. Friction of the road reduces the speed by 1e-5 g * 0.1
  // s. The air meets the car at up to 0.3 m/s from the side. The force of the air rises to 1/2 *
  // 1.225 * 5 * 0.3 * 5.07 = 4.7 N, which is 2.3 N on average, or 0.06 % of 4000 N.
  EXPECT_NEAR(state.lateral_speed, 400.0 / 1317.0, Tolerance(3e-4));
  // The force acts at the center of gravity, so only the air causes a yaw rate. This yaw rate is
  // 0.28 m * 2.3 N * 0.1 s/2157 kg m^2 = 3e-5 rad/s.
  EXPECT_NEAR(state.yaw_rate, 0.0, Tolerance(1e-4));
  EXPECT_NEAR(state.roll, 0.0, Tolerance(1e-3));
  plant->Step({});
  EXPECT_NEAR(plant->Observe().lateral_speed, state.lateral_speed, Tolerance(1e-4));
}

TEST(ApplyLateralForce, MovesTheSingleTrackCarAndNotTheKinematicOne) {
  const World world;
  const PlantSetup setup{.car = Prius(), .world = world, .start = {.speed = 10.0}};
  const auto dynamic = MakePlant("single_track", setup);
  dynamic->ApplyLateralForce(4000.0);
  const double mass = Prius().params().mass;
  EXPECT_NEAR(dynamic->Observe().lateral_speed, 4000.0 * 0.002 / mass, Tolerance(1e-15));
  dynamic->Step({});
  EXPECT_GT(dynamic->Observe().pose.y, 0.0);
  const auto kinematic = MakePlant("kinematic", setup);
  kinematic->ApplyLateralForce(4000.0);
  kinematic->Step({});
  EXPECT_EQ(kinematic->Observe().pose.y, 0.0);
}

}  // namespace kick_test
}  // namespace trackbed
