#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "src/sim/differential.h"
#include "tests/sim/cars.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

/// Tests the driver aids: differential, anti-lock brakes and stability control.
namespace trackbed {
namespace driver_aids_test {

constexpr double kGravity = 9.81;  // [m/s^2]

/// A straight road along x whose left half (y > 0) has the friction factor `left`.
World Road(double left, double right) {
  World world;
  world.friction = right;
  if (left != right) {
    world.friction_patches.push_back({.area = {{0.0, 50.0, 0.0}, 4000.0, 100.0}, .friction = left});
  }
  return world;
}

/// Returns the speed of a wheel at the end of a step.
double SpeedAfter(const AxleWheel& wheel, double added, double timestep) {
  const double free = wheel.speed + (wheel.torque + added) * timestep / wheel.inertia;
  const double braked = wheel.friction * timestep / wheel.inertia;
  return free > braked ? free - braked : free < -braked ? free + braked : 0.0;
}

// The transmitted torque is optimal if either the wheels turn at the same speed after the step, or
// the largest torque acts on the faster wheel as a brake.
TEST(Differential, MakesTheSpeedsEqualUpToItsLargestTorque) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int equal = 0;
  int limited = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto wheel = [&] {
      return AxleWheel{.speed = 100.0 * unit(random),
                       .inertia = 0.1 + std::abs(unit(random)),
                       .torque = 1000.0 * unit(random),
                       .friction = std::max(0.0, 2000.0 * unit(random))};
    };
    const AxleWheel left = wheel();
    const AxleWheel right = wheel();
    const double most = i % 5 == 0   ? std::numeric_limits<double>::infinity()
                        : i % 5 == 1 ? 0.0
                                     : 20000.0 * std::abs(unit(random));
    const double c = CouplingTorque(left, right, most, 0.002);
    ASSERT_LE(std::abs(c), most);
    const double apart = SpeedAfter(left, c, 0.002) - SpeedAfter(right, -c, 0.002);
    if (std::abs(c) < most) {
      // The torques are up to 1e5 N m, so that rounding of 1e-16 changes a speed by up to 1e-12.
      ASSERT_NEAR(apart, 0.0, Tolerance(1e-10)) << i;
      ++equal;
    } else {
      ASSERT_LE(apart * c, 0.0) << i;
      ++limited;
    }
  }
  EXPECT_GT(equal, 400);
  EXPECT_GT(limited, 400);
}

/// The end of a start on split friction. The left wheels are on ice.
struct Start {
  VehicleState state;
  std::optional<AidState> aids;
  std::array<double, 2> turned{};  // Angles by which the front wheels turned [rad].
  double torque = 0.0;             // Drive torque [N m].
  double radius = 0.0;             // Wheel radius [m].
};

Start PullAway(const AidOptions& aids) {
  const CarModel car = CarWith("prius", {});
  const World world = Road(0.05, 1.0);
  const auto plant = MakePlant("mujoco:magic_formula", {.car = car,
                                                        .world = world,
                                                        .start = {.speed = 3.0},
                                                        .steering = SteeringInput::kPrescribed,
                                                        .aids = aids});
  constexpr double kAcceleration = 2.0;  // [m/s^2]
  const double mass = car.params().mass;
  const double radius = car.params().wheel_radius;
  // The four wheels have the inertia 0.8 kg m^2, bearing friction of 1 N m each, and a rolling
  // resistance of 0.01. The drag at 3.6 m/s is 1.4 N m.
  Start start{.torque = kAcceleration * (mass * radius + 4.0 * 0.8 / radius) + 4.0 +
                        0.01 * mass * kGravity * radius + 1.4,
              .radius = radius};
  start.state = Drive(
      car, *plant, 0.3,
      [](double, const VehicleState&) { return Command{.acceleration = kAcceleration}; },
      [](double, const VehicleState&) {});
  start.aids = plant->aids();
  const std::vector<std::string> columns = car.configuration_columns();
  const std::vector<double> configuration = plant->Configuration();
  for (std::size_t w = 0; w < 2; ++w) {
    const auto found =
        std::find(columns.begin(), columns.end(), fmt::format("spin_{}_rad", kWheels[w]));
    start.turned[w] = configuration[static_cast<std::size_t>(found - columns.begin())];
  }
  return start;
}

// Bearing friction (1 N m), rolling resistance (10 N m) and the spin-up of the wheel that grips
// (0.8 kg m^2 at less than 7 rad/s^2) take at most 18 N m of a wheel's torque.
constexpr double kLosses = 18.0;

TEST(Differential, WhenOpenDrivesTheWheelThatGripsWithHalfTheTorque) {
  const Start start = PullAway({});
  EXPECT_GT(start.turned[0], 2.0 * start.turned[1]);
  EXPECT_FALSE(start.aids.has_value());
  const double torque = (*start.state.wheels)[1].longitudinal_force * start.radius;
  EXPECT_LT(torque, 0.5 * start.torque);
  EXPECT_GT(torque, 0.5 * start.torque - Tolerance(kLosses));
}

TEST(Differential, WhenLockedTurnsBothWheelsTogether) {
  const Start start = PullAway({.differential = Differential::kLocked});
  // The coupling does not know the accelerations of the chassis, so the speeds differ by at most
  // the effect of one step, about 1e-3 rad/s.
  EXPECT_NEAR(start.turned[0], start.turned[1], Tolerance(1e-3));
  const auto& wheels = *start.state.wheels;
  const double torque =
      (wheels[0].longitudinal_force + wheels[1].longitudinal_force) * start.radius;
  EXPECT_LT(torque, start.torque);
  EXPECT_GT(torque, start.torque - 2.0 * Tolerance(kLosses));
}

TEST(Differential, WithLimitedSlipTransmitsPreloadAndRamp) {
  const double preload = 60.0;
  const double ramp = 0.3;
  const Start start = PullAway({.differential = Differential::kLimitedSlip,
                                .differential_preload = preload,
                                .differential_ramp = ramp});
  const double transmitted = 0.5 * (preload + ramp * start.torque);
  // The torque flows from the left to the right wheel. The rolling resistance varies with the
  // wheel loads, by less than 1 % of the drive torque.
  EXPECT_NEAR(*start.aids->differential_torque, -transmitted, Tolerance(0.01) * transmitted);
  EXPECT_GT(start.turned[0], start.turned[1] + 1.0);
  const double torque = (*start.state.wheels)[1].longitudinal_force * start.radius;
  EXPECT_LT(torque, 0.5 * start.torque + transmitted);
  EXPECT_GT(torque, 0.5 * start.torque + transmitted - Tolerance(kLosses));
}

TEST(Differential, InATurnWithoutDriveTransmitsHalfItsPreload) {
  const CarModel car = CarWith("bmw320i", {});
  const World world;
  const auto plant =
      MakePlant("mujoco:magic_formula", {.car = car,
                                         .world = world,
                                         .start = {.speed = 8.0, .steering = 0.2},
                                         .steering = SteeringInput::kPrescribed,
                                         .aids = {.differential = Differential::kLimitedSlip}});
  Drive(
      car, *plant, 0.5,
      [](double, const VehicleState&) { return Command{.steering = 0.2, .coast = true}; },
      [](double, const VehicleState&) {});
  EXPECT_EQ(plant->divergence(), "");
  // The turn is to the left, so the right wheel is faster and gives torque to the left wheel.
  const double preload = 0.02 * car.unladen().mass * kGravity * car.unladen().wheel_radius;
  EXPECT_NEAR(*plant->aids()->differential_torque, 0.5 * preload, Tolerance(1e-9) * preload);
}

/// The result of braking along the line y = 0 from 100 km/h.
struct Stop {
  double distance = 0.0;      ///< To 1 m/s [m].
  double deceleration = 0.0;  ///< Mean from 25 to 5 m/s [m/s^2].
  double deepest_slip = 0.0;  ///< Largest brake slip above 5 m/s.
  double yaw = 0.0;           ///< Largest magnitude of the yaw [rad].
  double active = 0.0;        ///< Time with anti-lock control of any wheel [s].
};

Stop Brake(const std::string& model, const World& world, bool abs, double command = -20.0) {
  const CarModel car = CarWith(model, {});
  const auto plant =
      MakePlant("mujoco:magic_formula",
                {.car = car, .world = world, .start = {.speed = 27.78}, .aids = {.abs = abs}});
  Stop stop;
  double fast = 0.0;  // Time at which the car reached 25 m/s [s].
  double slow = 0.0;
  VehicleState state = plant->Observe();
  for (double t = 0.0; state.speed > 1.0 && t < 60.0; t += car.timestep()) {
    const double steering = std::clamp(-0.5 * state.pose.yaw - 0.05 * state.pose.y, -0.3, 0.3);
    plant->Step({.steering = steering, .acceleration = command});
    state = plant->Observe();
    stop.distance = state.distance;
    fast = state.speed > 25.0 ? t : fast;
    slow = state.speed > 5.0 ? t : slow;
    stop.yaw = std::max(stop.yaw, std::abs(state.pose.yaw));
    for (std::size_t w = 0; w < kWheels.size() && state.speed > 5.0; ++w) {
      stop.deepest_slip = std::max(stop.deepest_slip, -(*state.wheels)[w].slip_ratio);
    }
    if (abs) {
      const std::array<bool, 4> active = *plant->aids()->abs_active;
      stop.active += std::count(active.begin(), active.end(), true) > 0 ? car.timestep() : 0.0;
    }
  }
  stop.deceleration = 20.0 / (slow - fast);
  return stop;
}

TEST(AntiLockBrakes, UseThePeakOfTheTyresOnEveryRoad) {
  for (const std::string model : {"prius", "bmw320i"}) {
    const CarModel car = CarWith(model, {});
    for (const double road : {0.8, 0.5, 0.2, 0.1}) {
      const Stop with = Brake(model, Road(road, road), true);
      const Stop without = Brake(model, Road(road, road), false);
      // The largest longitudinal force of the tyres at their loads at rest. Load transfer changes
      // the sum by a few percent, drag and rolling resistance add up to 0.4 m/s^2.
      double force = 0.0;
      for (std::size_t axle = 0; axle < 2; ++axle) {
        const VehicleParams& params = car.params();
        const double load = params.mass * kGravity / params.wheelbase *
                            (axle == 0 ? params.cg_to_rear : params.cg_to_front());
        force += load * PeakFriction(car.parts().tyres->axle[axle], 0.5 * load).longitudinal;
      }
      const double peak = road * force / car.params().mass;
      EXPECT_GT(with.deceleration, 0.93 * peak) << model << ", " << road;
      EXPECT_LT(with.deceleration, peak + 0.5) << model << ", " << road;
      EXPECT_LT(with.distance, without.distance) << model << ", " << road;
      EXPECT_GT(without.deepest_slip, 0.9) << model << ", " << road;
      EXPECT_LT(with.deepest_slip, 0.5) << model << ", " << road;
      EXPECT_LT(with.yaw, 0.01) << model << ", " << road;
    }
  }
}

TEST(AntiLockBrakes, LeaveGentleBrakingAlone) {
  for (const double road : {1.0, 0.3}) {
    const Stop with = Brake("prius", Road(road, road), true, -5.0 * road);
    const Stop without = Brake("prius", Road(road, road), false, -5.0 * road);
    EXPECT_EQ(with.active, 0.0) << road;
    // The brake torques differ by rounding.
    EXPECT_NEAR(with.distance, without.distance, Tolerance(1e-9) * without.distance) << road;
  }
}

TEST(AntiLockBrakes, KeepTheCarStraighterOnSplitFriction) {
  // The driver steers toward the line y = 0. The front wheels of the car without anti-lock brakes
  // lock, so that the car does not follow its steering and spins.
  const World split = Road(0.2, 0.8);
  for (const std::string model : {"prius", "bmw320i"}) {
    EXPECT_GT(Brake(model, split, false, -20.0).yaw, 1.0) << model;
    EXPECT_LT(Brake(model, split, true, -20.0).yaw, 0.3) << model;
  }
}

/// The response to a sine with dwell (FMVSS 126) of a coasting car.
struct Dwell {
  double ratio_1_00 = 0.0;  ///< Yaw rate 1.00 s after the end of the steering, over its peak.
  double ratio_1_75 = 0.0;
  double displacement = 0.0;  ///< Of the center of gravity 1.07 s after the begin [m].
  double torque = 0.0;        ///< Largest brake torque of stability control [N m].
};

Dwell SteerWithDwell(const std::string& model, double amplitude, double road, bool esc) {
  constexpr double kFrequency = 0.7;  // [Hz]
  constexpr double kDwell = 0.5;      // [s]
  const CarModel car = CarWith(model, {});
  World world;
  world.friction = road;
  const auto plant = MakePlant("mujoco:magic_formula", {.car = car,
                                                        .world = world,
                                                        .start = {.speed = 22.22},
                                                        .steering = SteeringInput::kPrescribed,
                                                        .aids = {.abs = esc, .esc = esc}});
  const double complete = 1.0 / kFrequency + kDwell;
  const double reversal = 0.5 / kFrequency;
  Dwell dwell;
  double peak = 0.0;
  const auto sine = [&](double t) {
    const double own = t < 1.5 * reversal ? t : std::max(1.5 * reversal, t - kDwell);
    return own < 2.0 * reversal ? amplitude * std::sin(kPi * own / reversal) : 0.0;
  };
  Drive(
      car, *plant, complete + 1.8,
      [&](double t, const VehicleState&) {
        return Command{.steering = sine(t + car.timestep()), .coast = true};
      },
      [&](double t, const VehicleState& state) {
        peak = t > reversal ? std::max(peak, std::abs(state.yaw_rate)) : 0.0;
        dwell.ratio_1_00 = t < complete + 1.0 ? std::abs(state.yaw_rate) / peak : dwell.ratio_1_00;
        dwell.ratio_1_75 = t < complete + 1.75 ? std::abs(state.yaw_rate) / peak : dwell.ratio_1_75;
        dwell.displacement = t < 1.07
                                 ? state.pose.y + car.params().cg_to_rear * std::sin(state.pose.yaw)
                                 : dwell.displacement;
        if (esc) {
          const EscState seen = *plant->aids()->esc;
          dwell.torque = std::max(
              dwell.torque, *std::max_element(seen.brake_torque.begin(), seen.brake_torque.end()));
        }
      });
  return dwell;
}

// The amplitudes are 6.5 times the steering angle at 0.3 g of the Prius and of the BMW, and 270
// degrees at the steering wheel of the Prius.
TEST(StabilityControl, LetsCarsPassTheSineWithDwell) {
  for (const auto& [model, amplitude] :
       {std::pair("prius", 0.1775), {"prius", 1.5 * kPi / 17.6}, {"bmw320i", 0.1}}) {
    for (const double side : {1.0, -1.0}) {
      const Dwell without = SteerWithDwell(model, side * amplitude, 1.0, false);
      const Dwell with = SteerWithDwell(model, side * amplitude, 1.0, true);
      // The BMW without stability control rolls over, which also turns its yaw rate.
      EXPECT_TRUE(without.ratio_1_00 > 0.35 || without.ratio_1_75 > 0.20 ||
                  std::string(model) == "bmw320i")
          << model << ", " << amplitude;
      EXPECT_LT(with.ratio_1_00, 0.35) << model << ", " << amplitude;
      EXPECT_LT(with.ratio_1_75, 0.20) << model << ", " << amplitude;
      EXPECT_GT(side * with.displacement, 1.83) << model << ", " << amplitude;
    }
  }
}

TEST(StabilityControl, StopsASpinOnSlipperyRoads) {
  for (const std::string model : {"prius", "bmw320i"}) {
    for (const double road : {0.5, 0.3}) {
      EXPECT_GT(SteerWithDwell(model, 0.15, road, false).ratio_1_75, 0.5) << model << ", " << road;
      EXPECT_LT(SteerWithDwell(model, 0.15, road, true).ratio_1_75, 0.20) << model << ", " << road;
    }
  }
}

TEST(StabilityControl, DoesNotActInAGentleTurn) {
  // At the steering angle of 0.3 g, the cars follow the reference within its band.
  EXPECT_EQ(SteerWithDwell("prius", 0.0273, 1.0, true).torque, 0.0);
  EXPECT_EQ(SteerWithDwell("bmw320i", 0.0156, 1.0, true).torque, 0.0);
}

TEST(DriverAids, AreRefusedWithoutSlippingTyres) {
  using testing::HasSubstr;
  const auto message = [](const std::string& model, const std::string& plant) {
    const CarModel car = CarWith(model, {});
    const World world;
    try {
      MakePlant(plant, {.car = car, .world = world, .start = {}, .aids = {.abs = true}});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(message("prius", "mujoco:contact"), HasSubstr("vehicle.aids: not on contact tyres"));
  EXPECT_THAT(message("prius", "mujoco:contact"), HasSubstr("vehicle.tyre: magic_formula"));
  EXPECT_THAT(message("diff_drive", "mujoco"), HasSubstr("has differential drive"));
  EXPECT_EQ(message("prius", "mujoco"), "none");
  EXPECT_EQ(message("prius", "kinematic"), "none");
  EXPECT_EQ(message("prius", "single_track"), "none");
}

TEST(DriverAids, OfAClonedPlantContinueTheSame) {
  const CarModel car = CarWith("bmw320i", {});
  const World world = Road(0.2, 0.8);
  const auto plant =
      MakePlant("mujoco:magic_formula",
                {.car = car,
                 .world = world,
                 .start = {.speed = 20.0},
                 .aids = {.abs = true, .esc = true, .differential = Differential::kLimitedSlip}});
  const auto command = [](double, const VehicleState&) { return Command{.acceleration = -9.0}; };
  Drive(car, *plant, 0.5, command, [](double, const VehicleState&) {});
  const auto twin = plant->Clone();
  const auto look = [](double, const VehicleState&) {};
  Drive(car, *plant, 0.5, command, look);
  Drive(car, *twin, 0.5, command, look);
  EXPECT_EQ(plant->Configuration(), twin->Configuration());
  EXPECT_EQ(plant->aids()->esc->brake_torque, twin->aids()->esc->brake_torque);
  EXPECT_EQ(*plant->aids()->abs_active, *twin->aids()->abs_active);
}

}  // namespace driver_aids_test
}  // namespace trackbed
