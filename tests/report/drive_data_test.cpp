#include "src/report/drive_data.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cstdint>
#include <cstring>
#include <vector>

#include "src/report/scene_data.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/tyre_grip.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

/// Decodes the numbers of a channel as the page does.
std::vector<double> NumbersIn(const ordered_json& channel) {
  using boost::archive::iterators::binary_from_base64;
  using boost::archive::iterators::transform_width;
  using Decoder = transform_width<binary_from_base64<std::string::const_iterator>, 8, 6>;
  const bool is_float = channel.contains("f4");
  std::string text = channel.at(is_float ? "f4" : "i2");
  const auto padding = std::count(text.begin(), text.end(), '=');
  std::replace(text.begin(), text.end(), '=', 'A');
  std::string bytes(Decoder(text.cbegin()), Decoder(text.cend()));
  bytes.resize(bytes.size() - static_cast<std::size_t>(padding));
  std::vector<double> numbers;
  for (std::size_t at = 0; at < bytes.size(); at += is_float ? 4 : 2) {
    if (is_float) {
      float value = 0.0F;
      std::memcpy(&value, bytes.data() + at, 4);
      numbers.push_back(static_cast<double>(value));
    } else {
      std::int16_t steps = 0;
      std::memcpy(&steps, bytes.data() + at, 2);
      numbers.push_back(channel.at("offset").get<double>() +
                        channel.at("scale").get<double>() * steps);
    }
  }
  return numbers;
}

CarModel Prius() {
  return {ComposeScene(FindModel("prius", ""), {}), "prius"};
}

/// A log with a row every 0.02 s for `duration`. The car drives along x at 1 m/s, and its actuator
/// lags behind the command by `short_by(row)` [rad].
template <typename ShortBy>
std::string DriveAlongX(double duration, const ShortBy& short_by) {
  std::string csv = "t_s,x_m,y_m,yaw_rad,steering_command_rad,steering_actuator_rad\n";
  for (int i = 0; 0.02 * i <= duration; ++i) {
    // The measured angle in the next row shows whether the actuator reached the command of this
    // row.
    csv += fmt::format("{0:.2f},{0:.2f},0,0,0.1,{1}\n", 0.02 * i, 0.1 - short_by(i));
  }
  return csv;
}

TEST(EventsJson, JoinsAndDropsShortTimesAtTheRateLimit) {
  const TempFolder folder;
  const auto file = folder.Write("log.csv", DriveAlongX(10.0, [](int i) {
                                   const bool is_short = (i > 50 && i <= 75)        // 1.0 to 1.5 s
                                                         || (i > 78 && i <= 100)    // 1.56 to 2.0 s
                                                         || (i > 200 && i <= 202);  // 0.04 s
                                   return is_short ? 0.05 : 0.0;
                                 }));
  const ordered_json events = EventsJson(file, World{}, Prius().params());
  EXPECT_EQ(events["rate_limit"].dump(), "[[1.0,2.0]]");
  EXPECT_EQ(events["known"].dump(), "[]");
}

TEST(EventsJson, SaysWhenObstaclesBecomeKnown) {
  const TempFolder folder;
  const auto file = folder.Write("log.csv", DriveAlongX(12.0, [](int) { return 0.0; }));
  const VehicleParams car = Prius().params();
  World world;
  const OrientedBox box{.center = {40.0, 0.0, 0.0}, .length = 2.0, .width = 2.0};
  world.obstacles = {{.footprint = box},
                     {.footprint = box, .known_from_time = 2.5},
                     {.footprint = box, .known_from_range = 30.0},
                     {.footprint = box, .known_from_range = 5.0}};
  // The front of the car is `length - rear_overhang` ahead of x = t. It is 30 m from the near side
  // of the box, at 39 m.
  const double t = 39.0 - 30.0 - (car.length - car.rear_overhang);
  const ordered_json known = EventsJson(file, world, car)["known"];
  ASSERT_EQ(known.size(), 2U);  // without those known from the start or never in range
  EXPECT_EQ(known[0].dump(), "[1,2.5]");
  EXPECT_EQ(known[1][0], 2);
  EXPECT_NEAR(known[1][1].get<double>(), t, 0.02);  // time of the first row thereafter
}

TEST(TyresJson, IsTheShareOfTheGripOnTheRoadUnderEachWheel) {
  const TempFolder folder;
  const CarModel car = Prius();
  World world;
  world.friction = 0.8;
  // A friction patch under the left wheels only.
  world.friction_patches = {
      {.area = {.center = {5.0, 10.0, 0.0}, .length = 40.0, .width = 20.0}, .friction = 0.4}};
  std::string csv = "t_s,x_m,y_m,yaw_rad";
  std::string forces;
  for (const char* wheel : kWheels) {
    csv += fmt::format(",normal_force_{0}_N,longitudinal_force_{0}_N,lateral_force_{0}_N", wheel);
    forces += ",3000,-300,600";
  }
  csv += "\n";
  for (int i = 0; i <= 10; ++i) {
    csv += fmt::format("{:.2f},0,0,0{}\n", 0.1 * i, forces);
  }
  const auto file = folder.Write("mujoco.csv", csv);
  // The friction of MuJoCo's contacts of the Prius is 0.9.
  const ordered_json tyres = TyresJson(file, "mujoco:contact", TyreLaw::kAuto, world, car, 1000);
  EXPECT_EQ(NumbersIn(tyres["t"]).size(), 11U);
  for (const char* wheel : kWheels) {
    const double road = wheel[1] == 'l' ? 0.4 : 0.8;
    const double most = 0.9 * road * 3000.0;
    // A constant channel has no quantization error.
    EXPECT_NEAR(NumbersIn(tyres[wheel]["along"])[3], -300.0 / most, Tolerance(1e-12)) << wheel;
    EXPECT_NEAR(NumbersIn(tyres[wheel]["across"])[3], 600.0 / most, Tolerance(1e-12)) << wheel;
  }
  const double mu = PeakFriction(car.parts().tyres->axle[0], 3000.0).lateral;
  const ordered_json formula = TyresJson(file, "mujoco", TyreLaw::kAuto, world, car, 1000);
  EXPECT_NEAR(NumbersIn(formula["fr"]["across"])[0], 600.0 / (mu * 0.8 * 3000.0), Tolerance(1e-12));
}

TEST(TyresJson, ShowsTheRowsWhereTheTyresUseMost) {
  const TempFolder folder;
  const CarModel car = Prius();
  std::string csv = "t_s,x_m,y_m,yaw_rad";
  for (const char* wheel : kWheels) {
    csv += fmt::format(",normal_force_{0}_N,longitudinal_force_{0}_N,lateral_force_{0}_N", wheel);
  }
  csv += "\n";
  for (int i = 0; i <= 1000; ++i) {  // every 2 ms
    csv += fmt::format("{:.3f},0,0,0", 0.002 * i);
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      csv += i == 503 ? ",3000,0,2500" : ",3000,0,100";
    }
    csv += "\n";
  }
  const ordered_json tyres = TyresJson(folder.Write("mujoco.csv", csv), "mujoco:contact",
                                       TyreLaw::kAuto, World{}, car, 1000);
  const std::vector<double> across = NumbersIn(tyres["rl"]["across"]);
  EXPECT_LT(across.size(), 70U);  // 30 per second
  // The channel has 65 535 steps between its minimum and maximum.
  EXPECT_NEAR(*std::max_element(across.begin(), across.end()), 2500.0 / 2700.0, Tolerance(2e-5));
}

TEST(TyresJson, IsNullWithoutForces) {
  const TempFolder folder;
  const auto file = folder.Write("kinematic.csv", DriveAlongX(1.0, [](int) { return 0.0; }));
  EXPECT_TRUE(TyresJson(file, "kinematic", TyreLaw::kAuto, World{}, Prius(), 100).is_null());
}

TEST(MotionJson, HoldsTheWindAtTheCar) {
  const TempFolder folder;
  const auto states = folder.Write("mujoco.state.csv",
                                   "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n"
                                   "0,0,0,0,1,0,0,0\n1,10,0,0,1,0,0,0\n2,20,0,0,1,0,0,0\n");
  const ordered_json vehicle{{"bodies", ordered_json::array()}};
  World world;
  EXPECT_FALSE(MotionJson(states, vehicle, world, 100).contains("wind"));
  world.wind.velocity = {3.0, -4.0};
  // A step gust of 5 m/s at the car's position after one second.
  world.wind.gusts = {{.velocity = {0.0, 5.0},
                       .shape = GustShape::kStep,
                       .area = OrientedBox{{10.0, 0.0, 0.0}, 4.0, 4.0}}};
  const ordered_json wind = MotionJson(states, vehicle, world, 100)["wind"];
  EXPECT_THAT(NumbersIn(wind["x"]), testing::ElementsAre(3.0, 3.0, 3.0));
  const std::vector<double> y = NumbersIn(wind["y"]);
  // The channel has 65 535 steps over 5 m/s.
  EXPECT_NEAR(y[0], -4.0, Tolerance(1e-4));
  EXPECT_NEAR(y[1], 1.0, Tolerance(1e-4));
  EXPECT_NEAR(y[2], -4.0, Tolerance(1e-4));
}

}  // namespace
}  // namespace trackbed
