#include "trackbed/sim/payload.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tests/support/case_names.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/plant.h"

namespace trackbed {
namespace payload_test {

constexpr double kGravity = 9.81;  // [m/s^2], MuJoCo's default

CarModel Unloaded(const std::string& name) {
  return CarModel(ComposeScene(FindModel(name, TRACKBED_SOURCE_DIR), {}), name);
}

CarModel Loaded(const std::string& name, const Payload& payload) {
  return CarModel(WithPayload(Unloaded(name), payload), name);
}

std::unique_ptr<Plant> Standing(const CarModel& car, TyreLaw tyre = TyreLaw::kContact,
                                const StartState& start = {}) {
  static const World world;
  return MakePlant("mujoco", {.car = car, .world = world, .start = start, .tyre = tyre});
}

double Column(const CarModel& car, const Plant& plant, const std::string& name) {
  const auto columns = car.configuration_columns();
  const auto at = std::find(columns.begin(), columns.end(), name) - columns.begin();
  return plant.Configuration().at(static_cast<std::size_t>(at));
}

TEST(Payload, MovesMassCenterOfGravityAndYawInertia) {
  const CarModel own = Unloaded("prius");
  const CarModel car = Loaded("prius", {.mass = 250.0, .x = -0.3, .y = 0.4, .z = 0.7});
  const double mass = own.params().mass;
  const double cg = (mass * own.params().cg_to_rear - 250.0 * 0.3) / (mass + 250.0);
  // By the parallel axis theorem, two masses m and M at the distance d add m M / (m + M) d^2.
  const double arm = std::hypot(own.params().cg_to_rear + 0.3, 0.4);
  const double inertia = own.params().yaw_inertia + 250.0 * mass / (mass + 250.0) * arm * arm;
  // Rounding of MuJoCo's sums over twelve bodies.
  EXPECT_NEAR(car.params().mass, mass + 250.0, Tolerance(1e-9));
  EXPECT_NEAR(car.params().cg_to_rear, cg, Tolerance(1e-12));
  EXPECT_NEAR(car.params().yaw_inertia, inertia, Tolerance(1e-8));
  EXPECT_NEAR(car.parts().cg_height, (mass * own.parts().cg_height + 250.0 * 0.7) / (mass + 250.0),
              Tolerance(1e-12));
  // The cornering stiffness grows with the load, and the payload is nearer to the rear axle than to
  // the front axle.
  EXPECT_GT(car.params().cornering_stiffness_rear, own.params().cornering_stiffness_rear);
  EXPECT_LT(car.params().cornering_stiffness_front, own.params().cornering_stiffness_front);
}

TEST(Payload, IsNotInTheUnladenCar) {
  const CarModel own = Unloaded("prius");
  const CarModel car = Loaded("prius", {.share = 0.5});
  EXPECT_NEAR(car.params().mass, 1.5 * own.params().mass, Tolerance(1e-9));
  const VehicleParams& unladen = car.unladen();
  EXPECT_EQ(unladen.mass, own.params().mass);
  EXPECT_NEAR(unladen.cg_to_rear, own.params().cg_to_rear, Tolerance(1e-12));
  EXPECT_NEAR(unladen.yaw_inertia, own.params().yaw_inertia, Tolerance(1e-8));
  EXPECT_NEAR(unladen.cornering_stiffness_rear, own.params().cornering_stiffness_rear,
              Tolerance(1e-6));
  EXPECT_EQ(unladen.wheelbase, own.params().wheelbase);
  EXPECT_EQ(own.unladen().mass, own.params().mass);
}

/// Compares the wheel loads with the static moments about the axles and the center line of a car
/// that is inclined by its pitch and roll angles.
TEST(Payload, LoadsTheWheelsAsStaticsSays) {
  const CarModel own = Unloaded("prius");
  const double m = 100.0;
  const double y = 0.2;
  const CarModel car = Loaded("prius", {.mass = m, .x = 0.0, .y = y});
  const auto plant = Standing(car);
  for (int i = 0; i < 50; ++i) {
    plant->Step({});
  }
  const VehicleState state = plant->Observe();
  const auto load = [&](std::size_t wheel) { return (*state.wheels)[wheel].normal_force; };
  const VehicleParams& p = own.params();
  const double weight = (p.mass + m) * kGravity;
  const double height = own.parts().cg_height;
  // The car still moves at less than 1 um/s with a frequency of about 10 1/s, so its accelerations
  // are below 1e-5 m/s^2.
  EXPECT_NEAR(load(0) + load(1) + load(2) + load(3), weight, Tolerance(0.05));
  // Nose up is a negative pitch: the center of gravity moves backward relative to the hubs, under
  // which the wheels touch. The center of gravity also sinks by 2 cm on the springs. The reduced
  // height changes the backward shift of 2 mm by a tenth, which changes the load by 1 N of 11 N.
  const double front = p.mass * kGravity * p.cg_to_rear / p.wheelbase +
                       weight * (height - p.wheel_radius) * std::sin(state.pitch) / p.wheelbase;
  EXPECT_LT(state.pitch, -0.005);
  EXPECT_NEAR(load(0) + load(1), front, Tolerance(2.0));
  // The center of gravity also moves to the left, the lower side; the roll angle is negative.
  // Wheels incline with the car and touch the ground below the center of their tread's curve, an
  // ellipse of 0.0925 m by 0.31075 m.
  const double above_tread = height - 0.0925 * 0.0925 / p.wheel_radius;
  const double moment =
      0.5 * p.track_front * (load(0) - load(1)) + 0.5 * p.track_rear * (load(2) - load(3));
  EXPECT_LT(state.roll, -0.001);
  EXPECT_NEAR(moment, m * kGravity * y - weight * above_tread * std::sin(state.roll),
              Tolerance(3.0));
}

TEST(Payload, SagsTheSpringsByItsWeight) {
  const CarModel car = Loaded("prius", {.mass = 100.0});
  const auto plant = Standing(car);
  plant->Step({});
  const VehicleState state = plant->Observe();
  const auto& wheels = *state.wheels;
  const double static_rear = 0.5 * 1317.0 * kGravity * 1.3 / 2.7;
  // The wheel's additional load compresses its spring of 22 kN/m. The slide joints are inclined by
  // the pitch of 8 mrad, whose cosine differs from 1 by 3e-5.
  EXPECT_NEAR(Column(car, *plant, "suspension_rl_m"),
              (wheels[2].normal_force - static_rear) / 22000.0, Tolerance(1e-5));
  EXPECT_GT(Column(car, *plant, "suspension_rl_m"), 0.02);
  EXPECT_LT(Column(car, *plant, "z_m"), -0.02);
}

/// A car and its tyre law.
class LadenCar : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

INSTANTIATE_TEST_SUITE_P(Cars, LadenCar,
                         testing::Values(std::tuple("prius", "contact"),
                                         std::tuple("prius", "magic_formula"),
                                         std::tuple("bmw320i", "contact"),
                                         std::tuple("bmw320i", "magic_formula"),
                                         std::tuple("tests/data/models/small_car.xml", "contact")),
                         kNamedByParameter);

TEST_P(LadenCar, StandsStillFromTheStart) {
  const auto& [name, law] = GetParam();
  const TyreLaw tyre =
      std::string_view(law) == "contact" ? TyreLaw::kContact : TyreLaw::kMagicFormula;
  const CarModel car = Loaded(name, {.share = 0.15});
  const auto plant = Standing(car, tyre, {.pose = {3.0, -2.0, 0.7}});
  const std::vector<double> start = plant->Configuration();
  for (int i = 0; i < 1500; ++i) {
    plant->Step({});
  }
  ASSERT_FALSE(plant->diverged());
  const std::vector<double> end = plant->Configuration();
  for (std::size_t i = 0; i < start.size(); ++i) {
    // For a full-size car, the deflections of the two tyre laws differ by less than a tenth of a
    // millimeter, because both are set up for the load in the file.
    EXPECT_NEAR(end[i], start[i], Tolerance(3e-4 * car.params().wheel_radius))
        << car.configuration_columns()[i];
  }
}

TEST(Payload, SlowsTheCarDownThatDoesNotKnowOfIt) {
  const CarModel own = Unloaded("prius");
  const CarModel car = Loaded("prius", {.mass = 400.0, .x = 1.4});
  const auto speed_of = [](const CarModel& model) {
    const auto plant = Standing(model, TyreLaw::kContact, {.speed = 5.0});
    for (int i = 0; i < 1000; ++i) {
      plant->Step({.acceleration = 1.0});
    }
    return plant->Observe().speed - 5.0;
  };
  // Both cars have the same drive force: the acceleration times the mass including the inertia of
  // the wheels, 0.8 kg m^2 each. The tolerance covers the difference in air drag.
  const double radius = own.params().wheel_radius;
  const double rolling = own.params().mass + 4.0 * 0.8 / (radius * radius);
  EXPECT_NEAR(speed_of(car) / speed_of(own), rolling / (rolling + 400.0), Tolerance(2e-3));
}

TEST(Payload, IsRefusedWhereTheCarFallsOver) {
  const CarModel own = Unloaded("prius");
  try {
    WithPayload(own, {.mass = 2000.0, .x = -3.0});
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("prius does not come to rest on four wheels with "
                                                 "a payload of 2000 kg at x = -3 m, y = 0 m"));
  }
}

}  // namespace payload_test
}  // namespace trackbed
