// Tests the plant single_track, from the numbers in a car's file to its motion.
// tests/vehicle/single_track_car_test.cpp tests the equations of the single-track car.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/cars.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace single_track_plant_test {

constexpr double kGravity = 9.81;
constexpr auto kNoLook = [](double, const VehicleState&) {};

/// The BMW on symmetric tyres whose stiffness is `front` and `rear` times their load.
CarModel OnTyres(double front, double rear, double timestep = 0.002, Numerics numerics = {}) {
  numerics.insert(kStripped.begin(), kStripped.end());
  numerics["p_ky1_front"] = -front;
  numerics["p_ky1_rear"] = -rear;
  return CarWith("bmw320i", numerics, timestep);
}

/// Understeer gradient K [s^2/m]: the difference of load over cornering stiffness between both
/// axles, divided by g.
double UndersteerGradient(double front, double rear) {
  return (1.0 / front - 1.0 / rear) / kGravity;
}

const World kRoad;

std::unique_ptr<Plant> SingleTrack(const CarModel& car, const StartState& start,
                                   const World& world = kRoad) {
  return MakePlant("single_track", {.car = car, .world = world, .start = start});
}

Command Hold(double speed, double steering, const VehicleState& state) {
  return {.steering = steering, .acceleration = 4.0 * (speed - state.speed)};
}

TEST(SingleTrackPlant, NeedsTyres) {
  Scene scene = ComposeScene(FindModel("prius", ""), {});
  scene.xml = std::regex_replace(scene.xml, std::regex("<numeric name=\"[pr]_[^>]*/>"), "");
  const CarModel bare(scene, "cars/bare.xml");
  EXPECT_NO_THROW(MakePlant("kinematic", {.car = bare, .world = kRoad}));
  try {
    SingleTrack(bare, {});
    FAIL() << "a car without tyres was driven";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "cars/bare.xml: the model prius has no tyre coefficients; the plant single_track "
                 "needs them in <custom>: p_cx1, p_dx1, p_kx1, p_cy1, p_dy1 and p_ky1, of both "
                 "axles under these names or of each with _front and _rear");
  }
}

// --- Closed forms --------------------------------------------------------------------------------

/// Returns the yaw gain r/tan(delta) after 16 s at a constant speed [1/s].
double Gain(const CarModel& car, double speed) {
  constexpr double kSteering = 0.01;
  const auto plant = SingleTrack(car, {.speed = speed, .steering = kSteering});
  const VehicleState end = Drive(
      car, *plant, 16.0, [&](double, const VehicleState& s) { return Hold(speed, kSteering, s); },
      kNoLook);
  return end.yaw_rate / std::tan(kSteering);
}

TEST(SingleTrackPlant, YawRateGainIsThatOfTheTyresInTheFile) {
  for (const auto& [front, rear] :
       {std::pair(12.0, 20.0), std::pair(18.0, 18.0), std::pair(20.0, 16.0)}) {
    const CarModel car = OnTyres(front, rear);
    const double wheelbase = car.params().wheelbase;
    for (const double speed : {1.0, 10.0, 20.0, 30.0}) {
      const double gain = speed / (wheelbase + UndersteerGradient(front, rear) * speed * speed);
      // The slowest mode of the car decays at a rate of 2 1/s, which is a factor of e^-32 after 16
      // s. The tolerance covers rounding.
      EXPECT_NEAR(Gain(car, speed) / gain, 1.0, Tolerance(1e-9))
          << front << ", " << rear << " at " << speed;
    }
  }
}

TEST(SingleTrackPlant, CharacteristicSpeedHasTheLargestGain) {
  const CarModel car = OnTyres(12.0, 20.0);
  const double wheelbase = car.params().wheelbase;
  const double characteristic = std::sqrt(wheelbase / UndersteerGradient(12.0, 20.0));
  const double gain = Gain(car, characteristic);
  EXPECT_NEAR(gain, 0.5 * characteristic / wheelbase, Tolerance(1e-9 * gain));
  EXPECT_GT(gain, Gain(car, 0.95 * characteristic));
  EXPECT_GT(gain, Gain(car, 1.05 * characteristic));
}

TEST(SingleTrackPlant, AboveItsCriticalSpeedAnOversteeringCarSpins) {
  constexpr double kFront = 20.0;
  constexpr double kRear = 14.0;
  const CarModel car = OnTyres(kFront, kRear);
  const VehicleParams& params = car.params();
  const double l_f = params.cg_to_front();
  const double l_r = params.cg_to_rear;
  const double wheelbase = params.wheelbase;
  const double weight = params.mass * kGravity;
  const double front = kFront * weight * l_r / wheelbase;  // C_f, C_r [N/rad]
  const double rear = kRear * weight * l_f / wheelbase;
  const double critical = std::sqrt(wheelbase / -UndersteerGradient(kFront, kRear));
  for (const double share : {0.8, 0.95, 1.05, 1.3}) {
    SCOPED_TRACE(share);
    const double speed = share * critical;
    // The slower eigenvalue is the larger root of l^2 + a l + b.
    const double a = (front + rear) / (params.mass * speed) +
                     (l_f * l_f * front + l_r * l_r * rear) / (params.yaw_inertia * speed);
    const double b = front * rear * wheelbase * wheelbase /
                     (params.mass * params.yaw_inertia * speed * speed) *
                     (1.0 - speed * speed / (critical * critical));
    const double slower = -0.5 * a + std::sqrt(0.25 * a * a - b);
    EXPECT_EQ(slower > 0.0, share > 1.0);
    const auto plant = SingleTrack(car, {.speed = speed, .steering = 0.001});
    const auto straighten = [](double, const VehicleState&) { return Command{}; };
    const double before = Drive(car, *plant, 3.0, straighten, kNoLook).yaw_rate;
    const double after = Drive(car, *plant, 1.0, straighten, kNoLook).yaw_rate;
    // The faster mode decays at a rate of about 10 1/s, so at most e^-20 of it remains relative to
    // the slower mode.
    EXPECT_NEAR(std::log(after / before), slower, Tolerance(1e-6));
  }
}

TEST(SingleTrackPlant, ACarThatSpinsEverFasterIsToldFromADrive) {
  const CarModel car = OnTyres(20.0, 10.0);
  const auto plant = SingleTrack(car, {.speed = 60.0, .steering = 0.01});
  const VehicleState end = Drive(
      car, *plant, 60.0, [](double, const VehicleState&) { return Command{}; },
      [&](double, const VehicleState& state) { ASSERT_TRUE(std::isfinite(state.yaw_rate)); });
  EXPECT_TRUE(plant->diverged());
  EXPECT_GT(std::abs(end.pose.yaw), 1e9);
}

// --- Components ---------------------------------------------------------------------------------

TEST(SingleTrackPlant, KnowsNothingOfTheWorld) {
  const CarModel car = OnTyres(12.0, 20.0);
  const World world{.friction = 0.2, .wind = {.velocity = {3.0, 15.0}}};
  const auto driven = [&](const World& road) {
    const auto plant = SingleTrack(car, {.speed = 15.0}, road);
    return Drive(
        car, *plant, 3.0, [](double, const VehicleState& s) { return Hold(15.0, 0.05, s); },
        kNoLook);
  };
  EXPECT_EQ(driven(world).pose, driven(kRoad).pose);
}

TEST(SingleTrackPlant, DrivesTheSameAtEveryTimestep) {
  constexpr double kAmplitude = 0.02;  // [rad], at omega = pi/s
  const auto driven = [](double timestep) {
    const CarModel car = OnTyres(12.0, 20.0, timestep);
    const auto plant = MakePlant("single_track", {.car = car,
                                                  .world = kRoad,
                                                  .start = {.speed = 20.0},
                                                  .steering = SteeringInput::kPrescribed});
    return Drive(
        car, *plant, 4.0,
        [&](double t, const VehicleState&) {
          return Command{.steering = kAmplitude * std::sin(kPi * (t + 0.5 * timestep))};
        },
        kNoLook);
  };
  const CarModel car = OnTyres(12.0, 20.0);
  const VehicleParams& params = car.params();
  const VehicleState fine = driven(0.001);
  for (const double timestep : {0.002, 0.004}) {
    SCOPED_TRACE(timestep);
    const VehicleState state = driven(timestep);
    // A sine that is held at its value in the middle of each step is larger by the fraction (omega
    // dt)^2/24, and so is the response. The car drifts at the mean heading y/x; its heading is at
    // most twice this mean.
    const double larger = std::pow(kPi * timestep, 2) / 24.0;
    EXPECT_NEAR(state.pose.x, fine.pose.x, Tolerance(larger * std::abs(fine.pose.y)));
    EXPECT_NEAR(state.pose.y, fine.pose.y, Tolerance(larger * std::abs(fine.pose.y)));
    EXPECT_NEAR(state.pose.yaw, fine.pose.yaw,
                Tolerance(larger * 2.0 * std::abs(fine.pose.y) / fine.pose.x));
    // In the second half of a step, the held angle is behind the sine. The integral of the
    // difference between the sine and the held angle is delta' timestep^2/8. It changes the yaw
    // rate by C_f l_f/I times the integral.
    const double response =
        params.cornering_stiffness_front * params.cg_to_front() / params.yaw_inertia;
    EXPECT_NEAR(state.yaw_rate, fine.yaw_rate,
                Tolerance(kAmplitude * kPi * response * timestep * timestep / 8.0));
  }
}

TEST(SingleTrackPlant, SteersWithTheActuatorsRateOrAtOnce) {
  const CarModel car = CarWith("prius", {});
  const double rate = car.params().steering_rate;
  for (const SteeringInput input : {SteeringInput::kActuator, SteeringInput::kPrescribed}) {
    const auto plant = MakePlant(
        "single_track", {.car = car, .world = kRoad, .start = {.speed = 10.0}, .steering = input});
    for (int i = 0; i < 100; ++i) {
      plant->Step({.steering = 0.1});
    }
    const bool prescribed = input == SteeringInput::kPrescribed;
    EXPECT_NEAR(plant->Observe().steering, prescribed ? 0.1 : rate * 0.2, Tolerance(1e-12));
  }
}

// --- Comparison with MuJoCo's car on Magic Formula tyres ----------------------------------------

struct Two {
  std::vector<VehicleState> single_track;
  std::vector<VehicleState> physical;
};

/// Runs both plants with the prescribed `steering(t)` at a constant speed.
template <typename Steering>
Two Both(const CarModel& car, double speed, double duration, const Steering& steering) {
  const auto states = [&](const char* name) {
    const auto plant = MakePlant(name, {.car = car,
                                        .world = kRoad,
                                        .start = {.speed = speed},
                                        .steering = SteeringInput::kPrescribed});
    std::vector<VehicleState> seen;
    Drive(
        car, *plant, duration,
        [&](double t, const VehicleState& s) {
          return Hold(speed, steering(t + car.timestep()), s);
        },
        [&](double, const VehicleState& s) { seen.push_back(s); });
    return seen;
  };
  return {states("single_track"), states("mujoco:magic_formula")};
}

/// Fraction of the steering angle that tyre slip takes: K u^2/(L + K u^2).
double SlipShare(const VehicleParams& params, double front, double rear, double speed) {
  const double slip = UndersteerGradient(front, rear) * speed * speed;
  return slip / (params.wheelbase + slip);
}

/// Relative increase of the slip angle over that of a linear tyre, at the lateral acceleration a.
/// The result is the Magic Formula sin(C atan(C_alpha alpha/(C D))) = F/D with F/D = a/(mu g),
/// inverted to third order.
double Softening(const MagicFormula& tyre, double acceleration) {
  const double used = acceleration / (tyre.p_dy1 * kGravity);
  return used * used * (1.0 / 6.0 + 1.0 / (3.0 * tyre.p_cy1 * tyre.p_cy1));
}

TEST(SingleTrackPlant, TurnsAsTheMagicFormulaCarDoes) {
  constexpr double kSpeed = 20.0;
  for (const auto& [front, rear] : {std::pair(15.0, 25.0), std::pair(18.0, 18.0)}) {
    const CarModel car = OnTyres(front, rear);
    const VehicleParams& params = car.params();
    const double share = SlipShare(params, front, rear, kSpeed);
    for (const double acceleration : {-1.0, 0.25, 0.5, 1.0, 2.0}) {
      SCOPED_TRACE(fmt::format("{}, {}: {} m/s^2", front, rear, acceleration));
      const double steering =
          std::atan(params.wheelbase * acceleration / (kSpeed * kSpeed * (1.0 - share)));
      const Two two = Both(car, kSpeed, 8.0, [&](double t) {
        return steering * std::clamp((t - 0.5) / 0.5, 0.0, 1.0);
      });
      const VehicleState& linear = two.single_track.back();
      const VehicleState& physical = two.physical.back();
      EXPECT_NEAR(linear.lateral_acceleration, acceleration, Tolerance(1e-6));
      // Softer tyres take more of the steering angle. Small-angle approximations, the drive force
      // against the front tyres' drag, and the second wheel of each axle also cause errors of
      // second order. The tolerance for all of these errors is the softening of the total slip.
      const double softer = Softening(car.parts().tyres->axle[0], acceleration);
      const double tolerance = (share + 1.0) * softer;
      EXPECT_NEAR(physical.yaw_rate / linear.yaw_rate, 1.0, Tolerance(tolerance));
      EXPECT_NEAR(physical.lateral_acceleration / linear.lateral_acceleration, 1.0,
                  Tolerance(tolerance));
      // The lateral speed is v = l_r r - u alpha_r. Both terms have the same tolerance.
      const double slip = std::abs(acceleration) / (rear * kGravity);
      EXPECT_NEAR(
          physical.lateral_speed, linear.lateral_speed,
          Tolerance(tolerance * (params.cg_to_rear * std::abs(linear.yaw_rate) + kSpeed * slip)));
    }
  }
}

TEST(SingleTrackPlant, WeavesAsTheMagicFormulaCarDoes) {
  constexpr double kSpeed = 20.0;
  constexpr double kFront = 15.0;
  constexpr double kRear = 25.0;
  constexpr double kSteering = 0.01;  // largest [rad]
  const CarModel car = OnTyres(kFront, kRear);
  const double share = SlipShare(car.params(), kFront, kRear, kSpeed);
  for (const double frequency : {0.125, 0.25, 0.5}) {
    SCOPED_TRACE(fmt::format("{} Hz", frequency));
    const double omega = 2.0 * kPi * frequency;
    const Two two =
        Both(car, kSpeed, 8.0, [&](double t) { return kSteering * std::sin(omega * t); });
    double yaw_rate = 0.0;  // largest
    double acceleration = 0.0;
    double roll = 0.0;
    double squares = 0.0;
    double apart = 0.0;
    ASSERT_EQ(two.physical.size(), two.single_track.size());
    for (std::size_t i = 0; i < two.physical.size(); ++i) {
      const VehicleState& linear = two.single_track[i];
      const VehicleState& physical = two.physical[i];
      yaw_rate = std::max(yaw_rate, std::abs(linear.yaw_rate));
      acceleration = std::max(acceleration, std::abs(linear.lateral_acceleration));
      roll = std::max(roll, std::abs(physical.roll));
      squares += std::pow(physical.yaw_rate - linear.yaw_rate, 2);
      apart = std::max(apart, (physical.pose.position() - linear.pose.position()).norm());
    }
    const double rms = std::sqrt(squares / static_cast<double>(two.physical.size()));
    // MuJoCo's car has effects that the single-track car lacks. These effects change the tyre
    // forces, and thereby the fraction of the steering angle that the slip takes. The roll angle
    // moves the center of gravity by the roll angle times the height h, which changes the
    // acceleration by omega^2 times this distance. The tyre forces follow the slip with a delay of
    // the relaxation length divided by u. The errors from roll and delay are a quarter of a period
    // out of phase. The tyres soften. Wheels of angular momentum H on a body that rolls at omega
    // roll cause a yaw moment M = H omega roll, equivalent to a steering angle of M (1/C_f +
    // 1/C_r)/L.
    const MagicFormula& tyre = car.parts().tyres->axle[0];
    const VehicleParams& params = car.params();
    const double rolls = omega * omega * car.parts().cg_height * roll / acceleration;
    const double late = omega * tyre.relaxation_length / kSpeed;
    const double momentum = 4.0 * car.parts().spin_inertia[0] * kSpeed / params.wheel_radius;
    const double yaws =
        momentum * omega * roll / params.wheelbase *
        (1.0 / params.cornering_stiffness_front + 1.0 / params.cornering_stiffness_rear);
    const double part =
        share * (std::hypot(rolls, late) + Softening(tyre, acceleration)) + yaws / kSteering;
    EXPECT_LT(rms, Tolerance(part * yaw_rate));
    // The heading error is the integral of the yaw-rate error. The mean of the heading error is not
    // zero, but 1/omega times the amplitude of the yaw-rate error.
    EXPECT_LT(apart, Tolerance(part * yaw_rate / omega * kSpeed * 8.0));
  }
}

}  // namespace single_track_plant_test
}  // namespace trackbed
