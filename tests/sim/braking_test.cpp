#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/sim/cars.h"
#include "tests/tolerance.h"

/// Compares the largest deceleration of VehicleParams with that of the MuJoCo cars.
namespace trackbed {
namespace {

struct Stop {
  double deceleration = 0.0;  ///< constant deceleration with the same stopping distance [m/s^2]
  double slip = 0.0;          ///< lowest slip ratio above 5 m/s; -1 for a locked wheel
};

/// Brakes from 20 m/s to 1 m/s on a straight, with a step to `asked` [m/s^2].
Stop Brake(const std::string& model, const std::string& plant_name, double asked,
           double road = 1.0) {
  const CarModel car = CarWith(model, {});
  World world;
  world.friction = road;
  const auto plant = MakePlant(plant_name, {.car = car, .world = world, .start = {.speed = 20.0}});
  const auto nothing = [](double, const VehicleState&) {};
  const double from =
      Drive(
          car, *plant, 0.5, [](double, const VehicleState&) { return Command{}; }, nothing)
          .distance;
  const double speed = plant->Observe().speed;
  Stop stop;
  VehicleState state = plant->Observe();
  while (state.speed > 1.0) {
    plant->Step({.acceleration = -asked});
    state = plant->Observe();
    for (const WheelState& wheel : *state.wheels) {
      if (state.speed > 5.0) {
        stop.slip = std::min(stop.slip, wheel.slip_ratio);
      }
    }
  }
  stop.deceleration = 0.5 * (speed * speed - state.speed * state.speed) / (state.distance - from);
  return stop;
}

const std::vector<std::string> kLaws{"mujoco:contact", "mujoco:magic_formula"};

TEST(Braking, ThePriusBrakesAsHardAsItsLimitAndHoldsItsWheels) {
  for (const std::string& plant : kLaws) {
    for (const double road : {1.0, 0.4}) {
      SCOPED_TRACE(fmt::format("{}, road {}", plant, road));
      const double limit = MaxDeceleration(CarWith("prius", {}).params(), road);
      const Stop stop = Brake("prius", plant, limit, road);
      // The car reaches the commanded deceleration, except for slip in the first 0.02 s and bearing
      // friction.
      EXPECT_NEAR(stop.deceleration, limit, Tolerance(0.002 * limit));
      EXPECT_GT(stop.slip, -0.9);
    }
  }
}

TEST(Braking, HarderThanThatAWheelLocksAndTheCarBrakesNoHarder) {
  // The wheels of the bare contacts lock at 10 % more than the limit. Magic Formula tyres have a
  // larger friction coefficient than the contacts, 0.9, only while they roll.
  const double limit = CarWith("prius", {}).params().max_deceleration;
  const Stop on_tyres = Brake("prius", "mujoco:magic_formula", 1.1 * limit);
  EXPECT_LT(on_tyres.slip, -0.99);
  EXPECT_LT(on_tyres.deceleration, limit);
  const Stop on_contacts = Brake("prius", "mujoco:contact", 1.1 * limit);
  EXPECT_LT(on_contacts.slip, -0.99);
  EXPECT_LT(on_contacts.deceleration, 0.9 * 9.81);  // mu g
}

TEST(Braking, TheBmwsPitchLocksItsRearWheelsABitBelowItsLimit) {
  // The rear axle limits the braking of the BMW. While the car begins to pitch, the load of this
  // axle is smaller than in the steady state. At 95 % of the limit, no wheel locks. After a step to
  // the limit, the locked wheels reduce the deceleration by 5 %.
  const double limit = CarWith("bmw320i", {}).params().max_deceleration;
  for (const std::string& plant : kLaws) {
    SCOPED_TRACE(plant);
    const Stop below = Brake("bmw320i", plant, 0.95 * limit);
    EXPECT_NEAR(below.deceleration, 0.95 * limit, Tolerance(0.003 * limit));
    EXPECT_GT(below.slip, -0.9);
    const Stop at = Brake("bmw320i", plant, limit);
    EXPECT_GT(at.deceleration, 0.95 * limit);
  }
}

}  // namespace
}  // namespace trackbed
