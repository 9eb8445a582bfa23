#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/sim/cars.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace wind_test {

constexpr double kAirDensity = 1.225;  // [kg/m^3]
constexpr double kDragArea = 0.5;      // [m^2]
constexpr double kSideArea = 5.0;      // [m^2]

/// The Prius with round numbers for its aerodynamics.
const CarModel& Prius() {
  static const CarModel car =
      CarWith("prius", {{"drag_area", kDragArea}, {"side_area", kSideArea}});
  return car;
}

/// The sum of all tyre forces in the car's axes, and of their moments about the z axis through the
/// rear-axle center. The wheels point straight ahead.
struct Held {
  double forward = 0.0;  // [N]
  double left = 0.0;     // [N]
  double yaw = 0.0;      // [N m]
};

Held HeldBy(const VehicleState& state) {
  const VehicleParams& params = Prius().params();
  Held held;
  for (std::size_t w = 0; w < 4; ++w) {
    const WheelState& wheel = (*state.wheels)[w];
    const double x = w < 2 ? params.wheelbase : 0.0;
    const double y = (w % 2 == 0 ? 0.5 : -0.5) * (w < 2 ? params.track_front : params.track_rear);
    held.forward += wheel.longitudinal_force;
    held.left += wheel.lateral_force;
    held.yaw += x * wheel.lateral_force - y * wheel.longitudinal_force;
  }
  return held;
}

class OnBothTyres : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<Plant> At(const World& world, const StartState& start) {
    return MakePlant("mujoco:" + GetParam(), {.car = Prius(), .world = world, .start = start});
  }
};

INSTANTIATE_TEST_SUITE_P(Wind, OnBothTyres, testing::Values("contact", "magic_formula"),
                         [](const auto& tyre) { return tyre.param; });

TEST_P(OnBothTyres, AStandingCarIsPushedByHalfRhoVSquaredWhereItsPressureIs) {
  // The wind of 20 m/s meets a car with the heading 0.7 rad at 12 m/s along the car and 16 m/s
  // across it.
  const double yaw = 0.7;
  const World world{
      .wind = {.velocity = 12.0 * Direction(yaw) + 16.0 * LeftNormal(Direction(yaw))}};
  const auto plant = At(world, {.pose = {3.0, -2.0, yaw}});
  Held mean;
  const double seconds = 1.0;
  const int count = static_cast<int>(std::lround(seconds / Prius().timestep()));
  Drive(
      Prius(), *plant, 4.0 + seconds, [](double, const VehicleState&) { return Command{}; },
      [&](double t, const VehicleState& state) {
        if (t < 4.0) {
          return;
        }
        const Held held = HeldBy(state);
        mean.forward += held.forward / count;
        mean.left += held.left / count;
        mean.yaw += held.yaw / count;
      });
  const double along = 0.5 * kAirDensity * 20.0 * 12.0 * kDragArea;   // 73.5 N
  const double across = 0.5 * kAirDensity * 20.0 * 16.0 * kSideArea;  // 980 N
  // The tyres balance the wind. The tolerance is 1 % of the larger force, for springs that still
  // settle and for the car's lean of 0.01 rad, which gives weight and load components along the
  // car's axes.
  EXPECT_NEAR(mean.forward, -along, Tolerance(10.0));
  EXPECT_NEAR(mean.left, -across, Tolerance(10.0));
  // The lever arm is that of the center of pressure, 1.68 m ahead of the rear axle: 1646 N m.
  EXPECT_NEAR(mean.yaw, -1.68 * across, Tolerance(0.015 * 1.68 * across));
}

TEST_P(OnBothTyres, ACarAtSteadySpeedIsDrivenAgainstTheAirItMeets) {
  for (const double wind : {0.0, -10.0, 10.0, 20.0}) {  // calm, headwind, two tailwinds
    const World world{.wind = {.velocity = {wind, 0.0}}};
    const auto plant = At(world, {.speed = 10.0});
    double mean = 0.0;
    const int count = static_cast<int>(std::lround(2.0 / Prius().timestep()));
    const VehicleState end = Drive(
        Prius(), *plant, 5.0,
        [](double, const VehicleState& s) {
          return Command{.acceleration = 2.0 * (10.0 - s.speed)};
        },
        [&](double t, const VehicleState& state) {
          mean += t < 3.0 ? 0.0 : HeldBy(state).forward / count;
        });
    const double air = wind - 10.0;
    // The air force ranges from 31 N forward to 123 N backward. The tolerance of 4 N allows a
    // remaining acceleration of 3 mm/s^2.
    EXPECT_NEAR(mean, -0.5 * kAirDensity * std::abs(air) * air * kDragArea, Tolerance(4.0)) << wind;
    // The motor compensates the air drag before the speed deviates.
    EXPECT_NEAR(end.speed, 10.0, Tolerance(0.02)) << wind;
  }
}

TEST_P(OnBothTyres, AGustOnAStretchPushesTheCarThereAndNotBefore) {
  const World calm;
  const World gusty{.wind = {.gusts = {{.velocity = {0.0, 20.0},
                                        .shape = GustShape::kStep,
                                        .area = OrientedBox{{40.0, 0.0, 0.0}, 20.0, 8.0}}}}};
  const auto drive = [](const World& world) {
    std::vector<VehicleState> states;
    const auto plant = At(world, {.speed = 20.0});
    const auto hold = [](double, const VehicleState& s) {
      return Command{.acceleration = 2.0 * (20.0 - s.speed)};
    };
    Drive(Prius(), *plant, 2.4, hold, [&](double, const VehicleState& s) { states.push_back(s); });
    return states;
  };
  const auto as_ever = drive(calm);
  const auto pushed = drive(gusty);
  double acceleration = 0.0;
  double yaw_rate = 0.0;
  for (std::size_t i = 0; i < pushed.size() && pushed[i].pose.x < 50.0; ++i) {
    if (pushed[i].pose.x < 30.0) {
      EXPECT_EQ(pushed[i].pose, as_ever[i].pose) << pushed[i].time;
      continue;
    }
    acceleration =
        std::max(acceleration, pushed[i].lateral_acceleration - as_ever[i].lateral_acceleration);
    yaw_rate = std::max(yaw_rate, pushed[i].yaw_rate - as_ever[i].yaw_rate);
  }
  // The air meets the car at 20 m/s along and 20 m/s across, which is 28.3 m/s in total. The
  // lateral force of 1/2 rho 28.3 * 20 * 5 = 1732 N accelerates 1317 kg by 1.32 m/s^2. The tyres,
  // here bare contacts, already balance most of this force.
  EXPECT_GT(acceleration, 0.25);
  EXPECT_LT(acceleration, 1.5);
  // The center of pressure is ahead of the center of gravity, so the nose turns away from the wind.
  EXPECT_GT(yaw_rate, 1e-3);
}

TEST(KinematicCar, DoesNotFeelWind) {
  const World world{.wind = {.velocity = {0.0, 30.0}}};
  const auto plant =
      MakePlant("kinematic", {.car = Prius(), .world = world, .start = {.speed = 10.0}});
  const VehicleState end = Drive(
      Prius(), *plant, 2.0, [](double, const VehicleState&) { return Command{}; },
      [](double, const VehicleState&) {});
  EXPECT_NEAR(end.pose.x, 20.0, Tolerance(1e-9));
  EXPECT_NEAR(end.pose.y, 0.0, Tolerance(1e-12));
}

}  // namespace wind_test
}  // namespace trackbed
