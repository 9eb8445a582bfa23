#include "trackbed/drive/car_cache.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"

namespace trackbed {
namespace {

Scenario WithBox(double x) {
  Scenario scenario;
  scenario.world.obstacles = {{.footprint = {{x, 3.0, 0.0}, 1.0, 1.0}}};
  return scenario;
}

TEST(CarCache, GivesTheCarThatLoadCarGives) {
  Scenario laden = WithBox(20.0);
  laden.disturb.payload = Payload{.mass = 300.0};
  laden.vehicle.steering_rate = 0.2;
  CarCache cars;
  for (const Scenario& scenario : {Scenario(), WithBox(20.0), laden}) {
    const CarModel loaded = LoadCar(scenario);
    const auto cached = cars.Load(scenario);
    EXPECT_EQ(cached->scene().xml, loaded.scene().xml);
    EXPECT_EQ(cached->params().mass, loaded.params().mass);
    EXPECT_EQ(cached->unladen().mass, loaded.unladen().mass);
    EXPECT_EQ(cached->params().steering_rate, loaded.params().steering_rate);
  }
}

TEST(CarCache, CompilesEveryModelOnce) {
  CarCache cars;
  const auto bare = cars.Load({});
  EXPECT_EQ(cars.compiled(), 1U);
  const auto near = cars.Load(WithBox(20.0));
  EXPECT_EQ(cars.compiled(), 2U);
  EXPECT_EQ(cars.Load(WithBox(20.0)), near);
  EXPECT_EQ(cars.Load({}), bare);
  EXPECT_EQ(cars.compiled(), 2U);
  EXPECT_NE(cars.Load(WithBox(30.0)), near);
  EXPECT_EQ(cars.compiled(), 3U);
  Scenario slow;
  slow.drive.timestep = 0.004;
  EXPECT_EQ(cars.Load(slow)->timestep(), 0.004);
  EXPECT_EQ(cars.compiled(), 4U);
}

TEST(CarCache, ForgetsWhatWasUsedLongestAgo) {
  CarCache cars(2);
  const auto kept = cars.Load(WithBox(20.0));  // also loads the car without obstacles
  const auto other = cars.Load(WithBox(30.0));
  EXPECT_EQ(cars.compiled(), 3U);
  EXPECT_EQ(kept->timestep(), 0.002);  // the caller's pointer stays valid
  EXPECT_EQ(cars.Load(WithBox(30.0)), other);
  EXPECT_EQ(cars.compiled(), 3U);
  EXPECT_NE(cars.Load(WithBox(20.0)), kept);
  EXPECT_EQ(cars.compiled(), 4U);
}

TEST(CarCache, LetsThreadsWaitForOneCompilation) {
  CarCache cars;
  std::vector<std::shared_ptr<const CarModel>> loaded(8);
  {
    std::vector<std::jthread> threads;
    for (auto& car : loaded) {
      threads.emplace_back([&] { car = cars.Load(WithBox(20.0)); });
    }
  }
  for (const auto& car : loaded) {
    EXPECT_EQ(car, loaded.front());
  }
  EXPECT_EQ(cars.compiled(), 2U);
}

TEST(CarCache, RefusesABadCarEveryTime) {
  Scenario scenario;
  scenario.vehicle.model = "prious";
  CarCache cars;
  EXPECT_THROW(cars.Load(scenario), InputError);
  scenario.vehicle.model = "prius";
  scenario.disturb.payload = Payload{.mass = 1e9};
  EXPECT_THROW(cars.Load(scenario), InputError);
  EXPECT_THROW(cars.Load(scenario), InputError);
  scenario.disturb.payload.reset();
  EXPECT_EQ(cars.Load(scenario)->params().name, "prius");
}

}  // namespace
}  // namespace trackbed
