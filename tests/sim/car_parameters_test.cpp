#include "trackbed/sim/car_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/plant.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

CarModel LoadShipped(const std::string& name) {
  return {ComposeScene(FindModel(name, ""), {}), name};
}

TEST(CarParameters, AreReadBack) {
  for (const char* model : {"prius", "bmw320i", "dart"}) {
    const CarModel car = LoadShipped(model);
    const std::vector<CarParameter> wanted{
        {.name = "mass", .value = 1.1 * car.params().mass},
        {.name = "cg_to_rear", .value = 0.95 * car.params().cg_to_rear},
        {.name = "cg_height", .value = 0.9 * car.chassis().cg_height},
        {.name = "yaw_inertia", .value = 1.2 * car.params().yaw_inertia},
        {.name = "p_ky1_front", .value = -11.0},
        {.name = "center_of_pressure[1]", .value = 0.3},
        {.name = "steering_rate", .value = 0.33},
        {.name = "steering_limit", .value = 0.4},
        {.name = "drive_torque", .value = 0.5 * CarParameterValue(car, "drive_torque")}};
    std::vector<CarParameter> own;
    for (const CarParameter& parameter : wanted) {
      if (parameter.name != "center_of_pressure[1]" || std::string(model) != "dart") {
        own.push_back(parameter);
      }
    }
    const CarModel changed(WithCarParameters(car, own), model);
    for (const CarParameter& parameter : own) {
      // The tolerance covers sums over a dozen bodies, each rounded once.
      EXPECT_NEAR(CarParameterValue(changed, parameter.name), parameter.value,
                  Tolerance(1e-9) * std::abs(parameter.value))
          << model << " " << parameter.name;
    }
    EXPECT_EQ(CarParameterValue(changed, "p_ky1_rear"), CarParameterValue(car, "p_ky1_rear"))
        << "of the other axle";
  }
}

TEST(CarParameters, LeaveTheCarStandingOnItsSprings) {
  const CarModel car = LoadShipped("prius");
  const CarModel changed(
      WithCarParameters(car, {{.name = "mass", .value = 1.3 * car.params().mass},
                              {.name = "cg_to_rear", .value = 0.9 * car.params().cg_to_rear}}),
      "heavy");
  const World world;
  const auto height = [&](const CarModel& model) {
    const auto plant = MakePlant("mujoco", {.car = model, .world = world, .start = {}});
    for (int i = 0; i < 500; ++i) {  // 1 s
      plant->Step({});
    }
    return plant->Configuration()[2];
  };
  // The springs are preloaded for the additional mass. The tyres, 230 kN/m each under a quarter of
  // 440 kg more, deflect by another 5 mm, which the springs do not compensate.
  EXPECT_NEAR(height(changed), height(car), Tolerance(0.006));
}

TEST(CarParameters, SayWhatTheModelDoesNotHave) {
  const CarModel car = LoadShipped("prius");
  const auto message = [&](const std::string& name) {
    try {
      static_cast<void>(CarParameterValue(car, name));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message("yaw_inertai"), HasSubstr("did you mean 'yaw_inertia'?"));
  EXPECT_THAT(message("p_kyl_front"), HasSubstr("did you mean 'p_ky1_front'?"));
  EXPECT_THAT(message("center_of_pressure[2]"), HasSubstr("has 2 numbers, counted from 0"));
  EXPECT_THROW(static_cast<void>(WithCarParameters(car, {{.name = "mass", .value = 50.0}})),
               InputError);
  EXPECT_THROW(static_cast<void>(WithCarParameters(car, {{.name = "yaw_inertia", .value = 1.0}})),
               InputError);
}

TEST(CarParameters, KeepCommentsWhereTheyAreComments) {
  const CarModel car = LoadShipped("prius");
  const Scene scene = WithCarParameters(
      car, {{.name = "mass", .value = car.params().mass, .origin = "a --> b -- c"}});
  EXPECT_NO_THROW(CarModel(scene, "commented"));
}

}  // namespace
}  // namespace trackbed
