#include "trackbed/sim/plant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "tests/support/plant_names.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/world_scene.h"

// Tests laws that every plant obeys (directions, symmetry, actuator rate, stopping distance), then
// properties of the MuJoCo car against statics and closed forms.
namespace trackbed {
namespace {

const CarModel& Prius() {
  static const CarModel car(ComposeScene(FindModel("prius", ""), {}), "prius");
  return car;
}

/// The Prius on a road that outlives every plant.
PlantSetup PriusAt(const StartState& start, double friction = 1.0) {
  static std::map<double, World> roads;
  const World& road = roads.try_emplace(friction, World{.friction = friction}).first->second;
  return {.car = Prius(), .world = road, .start = start};
}

/// Holds the speed and commands a steering angle for `duration` [s].
void Hold(Plant& plant, double steering, double speed, double duration) {
  const auto steps = static_cast<int>(std::lround(duration / Prius().timestep()));
  for (int i = 0; i < steps; ++i) {
    const double error = i % 10 == 0 ? speed - plant.Observe().speed : 0.0;
    plant.Step({.steering = steering, .acceleration = 2.0 * error});
    ASSERT_FALSE(plant.diverged());
  }
}

/// Laws that every plant obeys.
class EveryPlant : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<Plant> At(const StartState& start, double friction = 1.0) {
    return MakePlant(GetParam(), PriusAt(start, friction));
  }
};

INSTANTIATE_TEST_SUITE_P(Plants, EveryPlant, testing::ValuesIn(PlantNames()),
                         [](const auto& plant) {
                           std::string name = plant.param;
                           std::replace(name.begin(), name.end(), ':', '_');
                           return name;
                         });

TEST_P(EveryPlant, StartsAsAsked) {
  const VehicleState state =
      At({.pose = {3.0, -2.0, 1.0}, .speed = 4.0, .steering = 0.1})->Observe();
  EXPECT_NEAR(state.pose.x, 3.0, Tolerance(1e-12));
  EXPECT_NEAR(state.pose.y, -2.0, Tolerance(1e-12));
  EXPECT_NEAR(state.pose.yaw, 1.0, Tolerance(1e-12));
  EXPECT_NEAR(state.speed, 4.0, Tolerance(1e-12));
  EXPECT_NEAR(state.steering_actuator, 0.1, Tolerance(1e-12));
  EXPECT_NEAR(state.steering, 0.1, Tolerance(1e-12));
  EXPECT_NEAR(state.yaw_rate, 4.0 * std::tan(0.1) / 2.7, Tolerance(1e-12));
  EXPECT_EQ(state.distance, 0.0);
}

TEST_P(EveryPlant, HeadingNorthMovesNorth) {
  const auto plant = At({.pose = {0.0, 0.0, kPi / 2.0}, .speed = 3.0});
  Hold(*plant, 0.0, 3.0, 2.0);
  const VehicleState state = plant->Observe();
  // The car drives 6 m in 2 s at 3 m/s, because the speed control compensates the bearing friction
  // of the MuJoCo car.
  EXPECT_NEAR(state.pose.y, 6.0, Tolerance(0.01));
  EXPECT_NEAR(state.pose.x, 0.0, Tolerance(1e-3));
  EXPECT_NEAR(state.distance, 6.0, Tolerance(0.01));
}

TEST_P(EveryPlant, PositiveSteeringTurnsLeft) {
  const auto plant = At({.speed = 3.0});
  Hold(*plant, 0.2, 3.0, 3.0);
  const VehicleState state = plant->Observe();
  EXPECT_GT(state.pose.yaw, 0.1);
  EXPECT_GT(state.pose.y, 0.1);
  EXPECT_GT(state.yaw_rate, 0.1);
  EXPECT_GT(state.lateral_acceleration, 0.1);
  EXPECT_GE(state.roll, 0.0);  // outward: the right side goes down
}

TEST_P(EveryPlant, MirrorsWithTheSteering) {
  const auto left = At({.speed = 3.0});
  const auto right = At({.speed = 3.0});
  Hold(*left, 0.3, 3.0, 4.0);
  Hold(*right, -0.3, 3.0, 4.0);
  const VehicleState a = left->Observe();
  const VehicleState b = right->Observe();
  // The model is mirror symmetric to rounding. The remaining difference is the contact solver's
  // tolerance of 1e-10 times the energy scale m g in each step, which moves the car by about 1e-6 m
  // over 2000 steps.
  const double tolerance = Tolerance(1e-5);
  EXPECT_NEAR(a.pose.x, b.pose.x, tolerance);
  EXPECT_NEAR(a.pose.y, -b.pose.y, tolerance);
  EXPECT_NEAR(a.pose.yaw, -b.pose.yaw, tolerance);
  EXPECT_NEAR(a.steering, -b.steering, tolerance);
}

TEST_P(EveryPlant, DrivesTheSameInEveryDirection) {
  const auto east = At({.speed = 3.0});
  Hold(*east, 0.3, 3.0, 4.0);
  const VehicleState reference = east->Observe();
  for (const double yaw : {0.7, 2.2, -1.3}) {
    const Pose2 start{10.0, -20.0, yaw};
    const auto turned = At({.pose = start, .speed = 3.0});
    Hold(*turned, 0.3, 3.0, 4.0);
    const Pose2 expected = Compose(start, reference.pose);
    const Pose2 actual = turned->Observe().pose;
    // As in MirrorsWithTheSteering, the remaining difference is the solver's tolerance, which
    // depends on the axes.
    const double tolerance = Tolerance(1e-5);
    EXPECT_NEAR(actual.x, expected.x, tolerance);
    EXPECT_NEAR(actual.y, expected.y, tolerance);
    EXPECT_NEAR(actual.yaw, expected.yaw, tolerance);
  }
}

TEST_P(EveryPlant, TakesAFullLockTimeToFullLock) {
  for (const double speed : {0.0, 3.0}) {
    for (const double sign : {1.0, -1.0}) {
      const auto plant = At({.speed = speed});
      const double limit = Prius().params().steering_limit;
      int steps = 0;
      // Stop at 0.999 of the limit, because a real servo only approaches its target.
      while (sign * plant->Observe().steering < 0.999 * limit && steps < 3000) {
        plant->Step({.steering = sign * 1.0, .acceleration = 0.0});
        ++steps;
      }
      // Turning to full lock takes limit / rate = 3.2337 s. The required accuracy is 1 %.
      EXPECT_NEAR(steps * 0.002, 3.2337, Tolerance(0.0323)) << "at " << speed << " m/s";
      EXPECT_LE(std::abs(plant->Observe().steering_actuator), limit + 1e-12);
    }
  }
}

TEST_P(EveryPlant, BrakesToRestAndStaysThere) {
  const auto plant = At({.speed = 3.0});
  for (int i = 0; i < 1500; ++i) {
    plant->Step({.acceleration = -2.0});
  }
  const VehicleState stopped = plant->Observe();
  // The stopping distance is v^2/(2 a) = 2.25 m. The brakes of the MuJoCo car act through tyres and
  // springs, which adds up to 2 %.
  EXPECT_NEAR(stopped.distance, 2.25, Tolerance(0.045));
  for (int i = 0; i < 5000; ++i) {
    plant->Step({.acceleration = 0.0});
  }
  const VehicleState later = plant->Observe();
  // A parked car does not creep for ten seconds. The tolerance of 0.1 mm covers the remaining
  // oscillation of the springs.
  EXPECT_NEAR(later.pose.x, stopped.pose.x, Tolerance(1e-4));
  EXPECT_NEAR(later.pose.y, stopped.pose.y, Tolerance(1e-4));
  EXPECT_NEAR(later.speed, 0.0, Tolerance(1e-5));
}

TEST_P(EveryPlant, AcceleratesFromRestAsAsked) {
  const auto plant = At({});
  for (int i = 0; i < 1000; ++i) {
    plant->Step({.acceleration = 1.0});
  }
  // The car accelerates for 2 s at 1 m/s^2. The bearings reduce the torque of about 410 N m by 4 N
  // m, which is 1 %.
  EXPECT_NEAR(plant->Observe().speed, 2.0, Tolerance(0.03));
}

TEST_P(EveryPlant, DrivesBackwardsInReverse) {
  const auto plant = At({});
  for (int i = 0; i < 1000; ++i) {
    plant->Step({.steering = 0.2, .acceleration = -1.0, .gear = -1});
  }
  const VehicleState state = plant->Observe();
  EXPECT_NEAR(state.speed, -2.0, Tolerance(0.03));
  EXPECT_LT(state.pose.x, -1.5);
  EXPECT_LT(state.yaw_rate, 0.0);  // wheels to the left, in reverse: the heading turns right
}

TEST_P(EveryPlant, UnwrapsItsHeading) {
  const auto plant = At({.speed = 3.0, .steering = 0.4});
  Hold(*plant, 0.4, 3.0, 16.0);  // 0.47 rad/s: more than one turn
  EXPECT_GT(plant->Observe().pose.yaw, 2.0 * kPi);
}

TEST(MakePlant, SuggestsTheNearestName) {
  try {
    MakePlant("mujoko", PriusAt({}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "unknown plant 'mujoko'; did you mean 'mujoco'?");
  }
}

TEST(MujocoPlant, StandsAtStaticLoad) {
  const auto plant = MakePlant("mujoco", PriusAt({}));
  for (int i = 0; i < 2500; ++i) {
    plant->Step({});
  }
  const VehicleState state = plant->Observe();
  ASSERT_TRUE(state.wheels.has_value());
  const auto& wheels = *state.wheels;
  const double weight = 1317.0 * 9.81;
  // The front axle carries l_g/L of the weight, with the distance l_g of the center of gravity from
  // the rear axle. The tolerance of 0.1 % covers settling springs.
  EXPECT_NEAR(wheels[0].normal_force, 0.5 * weight * 1.4 / 2.7, Tolerance(0.001 * weight));
  EXPECT_NEAR(wheels[1].normal_force, 0.5 * weight * 1.4 / 2.7, Tolerance(0.001 * weight));
  EXPECT_NEAR(wheels[2].normal_force, 0.5 * weight * 1.3 / 2.7, Tolerance(0.001 * weight));
  EXPECT_NEAR(wheels[3].normal_force, 0.5 * weight * 1.3 / 2.7, Tolerance(0.001 * weight));
  EXPECT_NEAR(state.roll, 0.0, Tolerance(0.0005));
  EXPECT_NEAR(state.pitch, 0.0, Tolerance(0.0005));
  EXPECT_NEAR(state.lateral_acceleration, 0.0, Tolerance(0.01));
}

TEST(MujocoPlant, TyresCarryTheCentripetalForce) {
  const double steering = 0.2;
  const auto plant = MakePlant("mujoco", PriusAt({.speed = 5.0, .steering = steering}));
  Hold(*plant, steering, 5.0, 6.0);
  const VehicleState state = plant->Observe();
  const FrontAngles front = AckermannAngles(Prius().params(), state.steering);
  const auto& w = *state.wheels;
  // The tyre forces along the car's y axis add up to m a_y.
  const double lateral =
      w[0].lateral_force * std::cos(front.left) + w[0].longitudinal_force * std::sin(front.left) +
      w[1].lateral_force * std::cos(front.right) + w[1].longitudinal_force * std::sin(front.right) +
      w[2].lateral_force + w[3].lateral_force;
  // The lateral acceleration is about 1.9 m/s^2, which is a force of 2500 N. The tolerance of 1 %
  // covers the remaining change of state and a lag of one step.
  EXPECT_NEAR(lateral, 1317.0 * state.lateral_acceleration, Tolerance(25.0));
  EXPECT_NEAR(state.lateral_acceleration, state.speed * state.yaw_rate, Tolerance(0.02));
  EXPECT_GT(w[1].normal_force, w[0].normal_force);  // load moves to the outer side
  for (const WheelState& wheel : w) {
    // Left turn: forces point left, so the tyres slip to the right.
    EXPECT_LT(wheel.slip_angle, 0.0);
    EXPECT_LE(std::hypot(wheel.lateral_force, wheel.longitudinal_force),
              0.9 * wheel.normal_force * 1.001);
  }
}

TEST(MujocoPlant, RollsAndPitchesAsIso8855Says) {
  const auto turning = MakePlant("mujoco", PriusAt({.speed = 6.0, .steering = 0.2}));
  Hold(*turning, 0.2, 6.0, 3.0);
  EXPECT_GT(turning->Observe().roll, 0.005);  // left turn: right side down, positive
  const auto braking = MakePlant("mujoco", PriusAt({.speed = 15.0}));
  for (int i = 0; i < 500; ++i) {
    braking->Step({.acceleration = -4.0});
  }
  const VehicleState state = braking->Observe();
  EXPECT_GT(state.pitch, 0.005);  // braking: nose down, positive
  EXPECT_LT(state.longitudinal_acceleration, -3.5);
}

TEST(MujocoPlant, SlipperyRoadLimitsBraking) {
  const auto distance = [](double friction) {
    const auto plant = MakePlant("mujoco:contact", PriusAt({.speed = 10.0}, friction));
    for (int i = 0; i < 10000 && plant->Observe().speed > 0.01; ++i) {
      plant->Step({.acceleration = -12.0});
    }
    return plant->Observe().distance;
  };
  // A command beyond the limit makes the wheels lock or nearly lock. The stopping distance is then
  // v^2/(2 mu g), where mu is 0.9 times the friction factor of the road. The tolerance of 5 %
  // covers the limit of the brake force at 1.02 m g and the load transfer, which unloads the rear
  // axle first.
  EXPECT_NEAR(distance(0.5), 100.0 / (2.0 * 0.45 * 9.81), Tolerance(0.57));
  EXPECT_NEAR(distance(0.2), 100.0 / (2.0 * 0.18 * 9.81), Tolerance(1.42));
}

TEST(MujocoPlant, DrivesOverABumpAndIsLevelAgain) {
  World world;
  world.ground.bumps = {{.area = {{10.0, 0.0, 0.0}, 3.0, 6.0}, .height = 0.08}};
  const Scene scene = WithGround(ComposeScene(FindModel("prius", ""), {}), world.ground);
  const CarModel car(scene, "prius");
  const auto plant = MakePlant("mujoco", {.car = car, .world = world, .start = {.speed = 5.0}});
  double highest = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double error = i % 10 == 0 ? 5.0 - plant->Observe().speed : 0.0;
    plant->Step({.acceleration = 2.0 * error});
    ASSERT_FALSE(plant->diverged());
    highest = std::max(highest, plant->Configuration()[2]);
  }
  const VehicleState state = plant->Observe();
  EXPECT_GT(highest, 0.05);
  // The state is 3 s and 25 m after the bump. Body modes of 1.3 Hz with a damping ratio of 0.3 have
  // decayed to exp(-0.3 * 8.2 * 3) = 6e-4 of 0.05 m, and the wheelbase is 2.7 m.
  EXPECT_GT(state.pose.x, 25.0);
  EXPECT_NEAR(state.pitch, 0.0, Tolerance(1e-3));
  EXPECT_NEAR(state.roll, 0.0, Tolerance(1e-3));
  EXPECT_NEAR(plant->Configuration()[2], 0.0, Tolerance(1e-3));
  EXPECT_NEAR(state.pose.y, 0.0, Tolerance(0.01));
}

TEST(MujocoPlant, SteeringFollowsTheActuatorClosely) {
  const auto plant = MakePlant("mujoco", PriusAt({.speed = 3.0}));
  Hold(*plant, 0.4, 3.0, 2.0);  // the wheels are still turning
  const VehicleState moving = plant->Observe();
  // A servo with lag tau follows a ramp with a delay of rate * tau. The time constant tau of the
  // model's servo is 10 ms, and the coupling of the wheels adds a lag of 10 ms. The steering angle
  // is therefore 0.15 rad/s * 20 ms = 0.003 rad behind.
  EXPECT_NEAR(moving.steering, moving.steering_actuator, Tolerance(0.003));
  Hold(*plant, 0.4, 3.0, 3.0);
  const VehicleState resting = plant->Observe();
  // When the wheels rest, the difference is the deflection of the servo under the aligning moment
  // and the error of the steering linkage's polynomial, 0.00024 rad.
  EXPECT_NEAR(resting.steering, 0.4, Tolerance(0.001));
}

}  // namespace
}  // namespace trackbed
