#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/cars.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/plant.h"
#include "trackbed/vehicle/steering_response.h"

namespace trackbed {
namespace {

constexpr const char* kCurve = "-0.4 -0.3 -0.1 -0.09 0 0 0.1 0.08 0.4 0.25";

/// The BMW with a steering response in its file.
CarModel Responding(const std::string& curve = kCurve) {
  const CarModel car = CarWith(
      "bmw320i",
      {{"steering_dead_time", 0.05}, {"steering_time_constant", 0.1}, {"steering_backlash", 0.01}});
  Scene scene = car.scene();
  scene.xml.insert(scene.xml.find("</custom>"),
                   fmt::format("<numeric name=\"steering_curve\" data=\"{}\"/>", curve));
  return {scene, "bmw320i"};
}

TEST(SteeringFilterPlant, ReadsTheResponseOfTheFile) {
  const SteeringResponse response = Responding().params().steering_response;
  EXPECT_EQ(response.dead_time, 0.05);
  EXPECT_EQ(response.time_constant, 0.1);
  EXPECT_EQ(response.backlash, 0.01);
  EXPECT_THAT(response.curve, testing::ElementsAre(Vec2(-0.4, -0.3), Vec2(-0.1, -0.09), Vec2(0, 0),
                                                   Vec2(0.1, 0.08), Vec2(0.4, 0.25)));
  EXPECT_TRUE(CarWith("bmw320i", {}).params().steering_response.ideal());
}

TEST(SteeringFilterPlant, IsTheSameOnEveryPlant) {
  const CarModel car = Responding();
  const World world;
  const auto command = [](double t) { return t < 1.0 ? 0.3 : -0.2; };
  for (const PlantEntry& entry : Plants()) {
    const auto plant = MakePlant(entry.name, {.car = car, .world = world, .start = {.speed = 5.0}});
    SteeringFilter filter(car.params().steering_response, car.timestep(), 0.0);
    const double step = car.params().steering_rate * car.timestep();
    double actuator = 0.0;
    Drive(
        car, *plant, 2.0, [&](double t, const VehicleState&) { return Command{command(t)}; },
        [&](double t, const VehicleState& state) {
          // MuJoCo sums rates times timesteps, so the tolerance covers 1000 roundings of numbers
          // below 1.
          EXPECT_NEAR(state.steering_actuator, actuator, Tolerance(1e-12))
              << entry.name << " " << t;
          actuator += std::clamp(filter.Pass(command(t)) - actuator, -step, step);
        });
  }
}

TEST(SteeringFilterPlant, LeavesPrescribedWheelsAlone) {
  const CarModel car = Responding();
  const World world;
  const auto plant =
      MakePlant("kinematic", {.car = car, .world = world, .steering = SteeringInput::kPrescribed});
  plant->Step({.steering = 0.3});
  EXPECT_NEAR(plant->Observe().steering, 0.3, Tolerance(1e-15));
}

TEST(SteeringFilterPlant, IsUnchangedByARefusedCommand) {
  const CarModel car = Responding();
  const World world;
  const PlantSetup setup{.car = car, .world = world, .start = {.speed = 5.0}};
  const auto plant = MakePlant("kinematic", setup);
  const auto other = MakePlant("kinematic", setup);
  for (int i = 0; i < 100; ++i) {
    EXPECT_THROW(plant->Step({.steering = std::nan("")}), PreconditionError);
    EXPECT_THROW(plant->Step({.steering = 0.3, .acceleration = std::nan("")}), PreconditionError);
    plant->Step({.steering = 0.2});
    other->Step({.steering = 0.2});
  }
  EXPECT_EQ(plant->Observe().pose.yaw, other->Observe().pose.yaw);
  EXPECT_NE(plant->Observe().pose.yaw, 0.0);
}

std::string Problems(const Numerics& numerics, const std::string& curve = kCurve) {
  try {
    Scene scene = CarWith("bmw320i", {}).scene();
    for (const auto& [name, value] : numerics) {
      scene.xml.insert(scene.xml.find("</custom>"),
                       fmt::format("<numeric name=\"{}\" data=\"{}\"/>", name, value));
    }
    scene.xml.insert(scene.xml.find("</custom>"),
                     fmt::format("<numeric name=\"steering_curve\" data=\"{}\"/>", curve));
    const CarModel car(scene, "bmw320i");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SteeringFilterPlant, AddsTheOffsetOfTheFile) {
  const SteeringResponse without =
      CarWith("bmw320i", {{"steering_offset", 0.0}}).params().steering_response;
  EXPECT_TRUE(without.ideal());
  const CarModel car = CarWith("bmw320i", {{"steering_offset", 0.012}});
  const MonotoneCurve curve(car.params().steering_response.curve);
  for (const double command : {-1.0, -0.3, 0.0, 0.1, 0.9}) {
    EXPECT_NEAR(curve.At(command), command + 0.012, Tolerance(1e-15)) << command;
  }
  Scene scene = Responding().scene();
  scene.xml.insert(scene.xml.find("</custom>"),
                   "<numeric name=\"steering_offset\" data=\"-0.02\"/>");
  const CarModel both(scene, "bmw320i");
  const SteeringResponse response = both.params().steering_response;
  EXPECT_NEAR(response.curve[1].x(), -0.1, Tolerance(1e-15));
  EXPECT_NEAR(response.curve[1].y(), -0.11, Tolerance(1e-15));
}

TEST(SteeringFilterPlant, RefusesNumbersOutOfRange) {
  EXPECT_EQ(Problems({}), "accepted");
  EXPECT_THAT(Problems({{"steering_dead_time", -0.1}}),
              testing::HasSubstr("steering_dead_time: must be between 0 and 10 s, found -0.1"));
  EXPECT_THAT(Problems({{"steering_time_constant", 11.0}}),
              testing::HasSubstr("steering_time_constant: must be between 0 and 10 s, found 11"));
  EXPECT_THAT(Problems({{"steering_backlash", 9.0}}),
              testing::HasSubstr("steering_backlash: must be between 0 and 2.132 rad, found 9"));
  EXPECT_THAT(Problems({{"steering_offset", -1.1}}),
              testing::HasSubstr("steering_offset: must be less than the steering limit of 1.066 "
                                 "rad to either side, found -1.1"));
  EXPECT_THAT(
      Problems({}, "0 0 1 1 2 2"),
      testing::HasSubstr("steering_curve: has 6 numbers; must be pairs of commanded angle"));
  EXPECT_THAT(Problems({}, "0 0 1 1 2 2 3"), testing::HasSubstr("steering_curve: has 7 numbers"));
  EXPECT_THAT(Problems({}, "0 0 1 1 2 0.5 3 3"),
              testing::HasSubstr("steering_curve: pair 3 is 2 0.5; both numbers must increase"));
}

}  // namespace
}  // namespace trackbed
