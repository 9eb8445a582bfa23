#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <regex>
#include <string>

#include "src/sim/mujoco_plant.h"
#include "tests/sim/cars.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

/// Tests the forces that Magic Formula cars use in place of MuJoCo's constraints: tyres as springs,
/// brakes and bearings as dry friction, and the steering linkage.
namespace trackbed {
namespace {

constexpr double kStandardGravity = 9.81;
const World kLevel;  // plants keep a reference to their world

std::unique_ptr<Plant> OnTyres(const CarModel& car, const World& world,
                               const StartState& start = {}) {
  return MakePlant("mujoco:magic_formula", {.car = car, .world = world, .start = start});
}

double Weight(const CarModel& car) {
  return car.params().mass * kStandardGravity;
}

double Load(const VehicleState& state) {
  return std::accumulate(
      state.wheels->begin(), state.wheels->end(), 0.0,
      [](double sum, const WheelState& wheel) { return sum + wheel.normal_force; });
}

TEST(TyreSprings, LeaveNoConstraintsOnTheRoad) {
  const World hilly{.ground = {.grade = {0.02, 0.01},
                               .bumps = {{.area = {{40.0, 0.0, 0.0}, 8.0, 8.0}, .height = 0.05}}}};
  for (const char* name : {"prius", "bmw320i"}) {
    for (const World& world : {World{}, hilly}) {
      const CarModel car = CarWith(name, {}, 0.002, world);
      const auto plant = OnTyres(car, world, {.speed = 15.0});
      const auto& mujoco = dynamic_cast<const MujocoPlant&>(*plant);
      // The car turns, brakes to rest at half a g, and stands.
      Drive(
          car, *plant, 8.0,
          [](double t, const VehicleState& s) {
            return Command{.steering = 0.03 * std::sin(t),
                           .acceleration = t < 3.0 ? 2.0 * (15.0 - s.speed) : -5.0};
          },
          [&](double t, const VehicleState&) {
            ASSERT_EQ(mujoco.constraint_rows(), 0) << name << " at " << t << " s";
          });
      EXPECT_LT(std::abs(plant->Observe().speed), 1e-3);
    }
  }
}

TEST(TyreSprings, GiveSixPercentOfTheRadiusByDefault) {
  const CarModel car = CarWith("prius", {});
  const double load = 0.25 * Weight(car);
  EXPECT_NEAR(load / car.parts().tyres->vertical_stiffness, 0.06 * car.params().wheel_radius,
              Tolerance(1e-12));
  EXPECT_EQ(CarWith("bmw320i", {}).parts().tyres->vertical_stiffness, 158294.0);
}

TEST(TyreSprings, AreRefusedWhenNegative) {
  EXPECT_THAT(
      [] {
        CarWith("prius", {{"tyre_vertical_stiffness", -1.0}, {"tyre_vertical_damping", -2.0}});
      },
      testing::ThrowsMessage<InputError>(
          testing::AllOf(testing::HasSubstr("tyre_vertical_stiffness: must not be negative"),
                         testing::HasSubstr("tyre_vertical_damping: must not be negative"))));
}

TEST(TyreSprings, NeedATimestepThatWheelsDoNotHopAt) {
  // The unsprung masses are 36 kg per front wheel and 30 kg per rear wheel. The largest stable
  // timestep is 2 sqrt(m/k) = 2 sqrt(30/4e7) = 1.73 ms.
  const CarModel car = CarWith("prius", {{"tyre_vertical_stiffness", 4e7}});
  EXPECT_THAT([&] { OnTyres(car, kLevel); },
              testing::ThrowsMessage<InputError>(
                  testing::HasSubstr("wheel hop would be unstable; must be at most 0.001732 s")));
  const CarModel finer = CarWith("prius", {{"tyre_vertical_stiffness", 4e7}}, 0.0015);
  const auto plant = OnTyres(finer, kLevel, {.speed = 10.0});
  const VehicleState state = Drive(
      finer, *plant, 2.0, [](double, const VehicleState&) { return Command{}; },
      [](double, const VehicleState&) {});
  EXPECT_NEAR(Load(state), Weight(finer), Tolerance(0.02 * Weight(finer)));
}

TEST(TyreSprings, LetWheelsLiftOffAndLand) {
  // The hump is 4 m long and 0.25 m high. At 20 m/s, its crest falls away from the wheels at v^2 k
  // = 400 m^2/s^2 * 0.3 1/m = 12 g.
  const World world{.ground = {.bumps = {{.area = {{20.0, 0.0, 0.0}, 4.0, 8.0}, .height = 0.25}}}};
  for (const char* name : {"prius", "bmw320i"}) {
    const CarModel car = CarWith(name, {}, 0.002, world);
    const auto plant = OnTyres(car, world, {.speed = 20.0});
    double least = 1e9;
    double most = 0.0;
    double in_the_air = 0.0;  // [s]
    const VehicleState state = Drive(
        car, *plant, 8.0,
        [](double t, const VehicleState& s) {
          return Command{.acceleration = t < 4.0 ? 20.0 - s.speed : -3.0};
        },
        [&](double, const VehicleState& s) {
          least = std::min(least, Load(s));
          most = std::max(most, Load(s));
          in_the_air += Load(s) == 0.0 ? 0.002 : 0.0;
        });
    EXPECT_FALSE(plant->diverged());
    EXPECT_EQ(least, 0.0) << name;
    EXPECT_GT(in_the_air, 0.05) << name;
    EXPECT_GT(most, 2.0 * Weight(car)) << name;
    // Four seconds later the car runs level again: body modes of 1.3 Hz with damping 0.3 have
    // decayed to e^-9.
    EXPECT_NEAR(Load(state), Weight(car), Tolerance(0.01 * Weight(car))) << name;
    EXPECT_NEAR(state.roll, 0.0, Tolerance(1e-3)) << name;
  }
}

TEST(DryFriction, HoldsASlopeWithoutCreep) {
  for (const char* name : {"prius", "bmw320i"}) {
    for (const double timestep : {0.001, 0.005}) {
      const World world{.ground = {.grade = {0.2, 0.0}}};
      const CarModel car = CarWith(name, {}, timestep, world);
      const auto plant = OnTyres(car, world);
      const auto stand = [&](double duration) {
        double fastest = 0.0;
        const VehicleState state = Drive(
            car, *plant, duration, [](double, const VehicleState&) { return Command{}; },
            [&](double, const VehicleState& s) { fastest = std::max(fastest, std::abs(s.speed)); });
        return std::pair(state, fastest);
      };
      // Springs and tyres first settle under the load on a slope. Their modes decay at a rate of at
      // least 2 1/s, to e^-24 after 12 s. The tolerances cover rounding.
      const VehicleState settled = stand(12.0).first;
      const auto [state, fastest] = stand(30.0);
      EXPECT_LT(std::abs(settled.pose.x), 0.002) << name;
      EXPECT_LT((state.pose.position() - settled.pose.position()).norm(), Tolerance(1e-9)) << name;
      EXPECT_LT(fastest, Tolerance(1e-9)) << name;
    }
  }
}

/// A Prius whose front wheels trail their steering axes by `trail` [m].
CarModel Trailing(double trail) {
  Scene scene = ComposeScene(FindModel("prius", ""), {.timestep = 0.002});
  for (const char* side : {"fl", "fr"}) {
    const std::string joint = fmt::format("<joint name=\"steer_{}\"", side);
    const std::size_t at = scene.xml.find(joint);
    TRACKBED_CHECK(at != std::string::npos, "no joint of {}", side);
    scene.xml.insert(at + joint.size(), fmt::format(" pos=\"{} 0 0\"", trail));
  }
  return {scene, "prius"};
}

TEST(SteeringLinkage, LoadsTheRackWithWhatTurnsTheWheels) {
  // Lateral forces act behind the steering axes. These forces turn the wheels toward straight
  // ahead, because the servo has a stiffness of only 2e5 N m/rad.
  constexpr double kTrail = 0.05;
  constexpr double kServo = 2e5;
  const CarModel car = Trailing(kTrail);
  const World world;
  const auto plant = OnTyres(car, world, {.speed = 10.0});
  const VehicleState state = Drive(
      car, *plant, 6.0,
      [](double, const VehicleState& s) {
        return Command{.steering = 0.1, .acceleration = 2.0 * (10.0 - s.speed)};
      },
      [](double, const VehicleState&) {});
  const double force = (*state.wheels)[0].lateral_force + (*state.wheels)[1].lateral_force;
  ASSERT_GT(force, 1000.0);
  const double given = state.steering_actuator - state.steering;
  // Drive forces at half the track turn the wheels against each other. The difference of the drive
  // forces, and the body's roll, which inclines the steering axes, contribute some percent.
  EXPECT_NEAR(given, force * kTrail / kServo, Tolerance(0.05 * force * kTrail / kServo));
}

}  // namespace
}  // namespace trackbed
