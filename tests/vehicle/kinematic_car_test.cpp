#include "trackbed/vehicle/kinematic_car.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/support/expect_near.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "tests/vehicle/wheel_pair.h"
#include "trackbed/core/angle.h"

// Tests the kinematic car: sign conventions, exact circles at constant steering, convergence with
// moving steering, rest and gears, and accelerations by second differences.
namespace trackbed {
namespace {

constexpr ReferencePoint kRear = ReferencePoint::kRearAxle;
constexpr ReferencePoint kCg = ReferencePoint::kCenterOfGravity;
constexpr double kSpeed = 3.0;

KinematicCar CarAt(const KinematicState& start, ReferencePoint reference = kRear) {
  return {ReferenceCar(), reference, start};
}

// --- Conventions ---------------------------------------------------------------------------------

TEST(KinematicCar, HeadingOfNinetyDegreesMovesAlongY) {
  KinematicCar car = CarAt({.pose = {0.0, 0.0, kPi / 2.0}, .speed = kSpeed});
  car.Step({}, 2.0);
  ExpectNear(car.state().pose, {0.0, 6.0, kPi / 2.0}, 1e-14);
}

TEST(KinematicCar, PositiveSteeringTurnsLeft) {
  for (const ReferencePoint reference : {kRear, kCg}) {
    KinematicCar car = CarAt({.speed = kSpeed}, reference);
    car.Step({.steering = 0.2}, 2.0);
    EXPECT_GT(car.state().pose.y, 0.0);
    EXPECT_GT(car.state().pose.yaw, 0.0);
    EXPECT_GT(car.FullState().lateral_acceleration, 0.0);
    EXPECT_GT(car.FullState().sideslip, 0.0);
  }
}

TEST(KinematicCar, PositiveSteeringTurnsRightwardsInReverse) {
  KinematicCar car = CarAt({.speed = -1.0, .steering = 0.2});
  car.Step({.steering = 0.2, .gear = -1}, 2.0);
  EXPECT_LT(car.state().pose.x, 0.0);
  EXPECT_GT(car.state().pose.y, 0.0);  // the tail swings to the left
  EXPECT_LT(car.state().pose.yaw, 0.0);
  EXPECT_NEAR(car.state().distance, 2.0, Tolerance(1e-14));
}

// --- Differential drive --------------------------------------------------------------------------

TEST(KinematicCar, WithDifferentialDriveIsTheUnicycleOfItsWheelSpeeds) {
  // A rigid body on two rolling wheels with the speeds v_L and v_R and the track width b has the
  // speed v = (v_R + v_L)/2 and the yaw rate psi' = (v_R - v_L)/b.
  const VehicleParams pair = WheelPair();
  const double track = 0.6;
  const double time = 2.3;
  for (const auto& [left, right] :
       {std::pair{1.0, 2.0}, {2.0, 1.0}, {1.5, 1.5}, {0.5, 1.9}, {-1.0, -1.4}}) {
    SCOPED_TRACE(fmt::format("wheels at {} and {} m/s", left, right));
    const double speed = 0.5 * (left + right);
    const double yaw_rate = (right - left) / track;
    const double steering = std::atan((right - left) / speed);
    KinematicCar car(pair, kRear, {.speed = speed, .steering = steering});
    car.Step({.steering = steering, .gear = speed < 0.0 ? -1 : 1}, time);
    const double turn = yaw_rate * time;
    const Pose2 expected = turn == 0.0 ? Pose2{speed * time, 0.0, 0.0}
                                       : Pose2{speed / yaw_rate * std::sin(turn),
                                               speed / yaw_rate * (1.0 - std::cos(turn)), turn};
    ExpectNear(car.state().pose, expected, 1e-14);
    EXPECT_NEAR(car.FullState().yaw_rate, yaw_rate, Tolerance(1e-14));
  }
}

TEST(KinematicCar, WithDifferentialDriveChangesItsRatioAtTheLimitedRate) {
  // At speed v, psi' = v tan(delta)/b with delta = omega t, so psi = -v ln(cos(omega t))/(b omega).
  const VehicleParams pair = WheelPair();
  KinematicCar car(pair, kRear, {.speed = 2.0});
  for (int i = 0; i < 50; ++i) {
    car.Step({.steering = 1.5}, 0.01);
  }
  EXPECT_NEAR(car.state().steering, 0.5, Tolerance(1e-14));
  // Steps of 10 ms with a fourth-order method err by much less than the 1e-10 of steps of 20 ms.
  EXPECT_NEAR(car.state().pose.yaw, -2.0 / 0.6 * std::log(std::cos(0.5)), Tolerance(1e-10));
  car.Step({.steering = 1.5}, 1.0);
  EXPECT_EQ(car.state().steering, pair.steering_limit);
}

// --- Constant steering: exact
// ---------------------------------------------------------------------

TEST(KinematicCar, YawRateIsSpeedOverRadius) {
  // If v is the speed of the center of gravity, the yaw rate is v/sqrt(r^2 + l_g^2) (Skackauskas,
  // dissertation, eq. (C.25), printed to 1e-6). If v is the speed of the rear axle, the yaw rate is
  // v/r.
  const std::vector<std::pair<double, double>> table{
      {5.1, 0.567251}, {10.0, 0.297103}, {20.0, 0.149634}, {50.0, 0.059976}, {154.0, 0.019480}};
  for (const auto& [radius, rate] : table) {
    SCOPED_TRACE(radius);
    const double steering = SteeringForCurvature(ReferenceCar(), 1.0 / radius);
    KinematicCar cg = CarAt({.speed = kSpeed, .steering = steering}, kCg);
    cg.Step({.steering = steering}, 1.0);
    EXPECT_NEAR(cg.state().pose.yaw, rate, Tolerance(0.5e-6));
    EXPECT_NEAR(cg.state().pose.yaw, kSpeed / std::hypot(radius, 1.4), Tolerance(1e-14));
    EXPECT_NEAR(cg.FullState().yaw_rate, kSpeed / std::hypot(radius, 1.4), Tolerance(1e-14));
    KinematicCar rear = CarAt({.speed = kSpeed, .steering = steering});
    rear.Step({.steering = steering}, 1.0);
    EXPECT_NEAR(rear.state().pose.yaw, kSpeed / radius, Tolerance(1e-14));
    EXPECT_NEAR(rear.FullState().yaw_rate, kSpeed / radius, Tolerance(1e-14));
  }
}

TEST(KinematicCar, CenterOfGravityRunsOnItsOwnRadius) {
  const std::vector<std::pair<double, double>> table{
      {5.1, 5.2887}, {10.0, 10.0975}, {20.0, 20.0489}, {50.0, 50.0196}, {154.0, 154.0064}};
  for (const auto& [radius, outer] : table) {
    SCOPED_TRACE(radius);
    const double steering = SteeringForCurvature(ReferenceCar(), 1.0 / radius);
    // The rear axle starts at the origin, so the circle's center is (0, r).
    KinematicCar car = CarAt({.speed = kSpeed, .steering = steering});
    car.Step({.steering = steering}, 2.7);
    const Vec2 center{0.0, radius};
    EXPECT_NEAR((car.state().pose.position() - center).norm(), radius, Tolerance(1e-12));
    const Vec2 cg = ToWorld(car.state().pose, {1.4, 0.0});
    EXPECT_NEAR((cg - center).norm(), outer, Tolerance(0.5e-4));
  }
}

/// The exact solution from (0, 0, 0) at constant steering.
Pose2 ExactCircle(ReferencePoint reference, double steering, double speed, double time) {
  const double slip = reference == kCg ? std::atan(1.4 * std::tan(steering) / 2.7) : 0.0;
  const double W = speed * std::cos(slip) * std::tan(steering) / 2.7;
  return {speed / W * (std::sin(W * time + slip) - std::sin(slip)),
          -speed / W * (std::cos(W * time + slip) - std::cos(slip)), W * time};
}

TEST(KinematicCar, ConstantSteeringIsExactWhateverTheStep) {
  Random random(21);
  for (int i = 0; i < 100; ++i) {
    const double steering = std::copysign(random.Uniform(0.01, 0.48), random.Uniform(-1.0, 1.0));
    const double speed = random.Uniform(0.5, 5.0);
    const double time = random.Uniform(0.1, 40.0);
    for (const ReferencePoint reference : {kRear, kCg}) {
      SCOPED_TRACE(fmt::format("case {}: steering {}, speed {}, time {}, cg {}", i, steering, speed,
                               time, reference == kCg));
      const Pose2 exact = ExactCircle(reference, steering, speed, time);
      KinematicCar once = CarAt({.speed = speed, .steering = steering}, reference);
      once.Step({.steering = steering}, time);
      // With radii of up to 270 m, cancellation in the closed form leaves an error of 270 m * 2^-52
      // = 6e-14 m. Angles of up to 20 rad are rounded by 2e-15 rad, which adds 270 m * 2e-15 =
      // 5e-13 m.
      ExpectNear(once.state().pose, exact, 2e-12);
      KinematicCar often = CarAt({.speed = speed, .steering = steering}, reference);
      for (int step = 0; step < 1000; ++step) {
        often.Step({.steering = steering}, time / 1000.0);
      }
      // In the worst case, 1000 roundings of distances of 200 m have the same sign: 1000 * 2.8e-14
      // m.
      ExpectNear(often.state().pose, exact, 3e-11);
      EXPECT_NEAR(often.state().distance, speed * time, Tolerance(3e-11));
      EXPECT_NEAR(often.FullState().time, time, Tolerance(1e-11));
    }
  }
}

TEST(KinematicCar, StraightOnIsExact) {
  KinematicCar car = CarAt({.pose = {1.0, 2.0, 0.3}, .speed = kSpeed}, kCg);
  car.Step({}, 10.0);
  ExpectNear(car.state().pose, {1.0 + 30.0 * std::cos(0.3), 2.0 + 30.0 * std::sin(0.3), 0.3},
             1e-14 * 30.0);
}

TEST(KinematicCar, AccelerationMovesAlongTheSameCircle) {
  // With constant steering the car's pose depends only on the distance.
  const double steering = 0.3;
  for (const ReferencePoint reference : {kRear, kCg}) {
    KinematicCar car = CarAt({.speed = 1.0, .steering = steering}, reference);
    car.Step({.steering = steering, .acceleration = 0.5}, 4.0);  // 4 + 4 = 8 m
    EXPECT_NEAR(car.state().distance, 8.0, Tolerance(1e-14));
    EXPECT_NEAR(car.state().speed, 3.0, Tolerance(1e-14));
    ExpectNear(car.state().pose, ExactCircle(reference, steering, 1.0, 8.0), 1e-13);
  }
}

TEST(KinematicCar, BothReferencePointsAreOneCar) {
  const double steering = 0.4;
  const double slip = std::atan(1.4 * std::tan(steering) / 2.7);
  KinematicCar rear = CarAt({.speed = kSpeed, .steering = steering});
  KinematicCar cg =
      CarAt({.pose = {1.4, 0.0, 0.0}, .speed = kSpeed / std::cos(slip), .steering = steering}, kCg);
  rear.Step({.steering = steering}, 3.0);
  cg.Step({.steering = steering}, 3.0);
  const VehicleState a = rear.FullState();
  const VehicleState b = cg.FullState();
  ExpectNear(b.pose, a.pose, 1e-13);
  EXPECT_NEAR(b.speed, a.speed, Tolerance(1e-14));
  EXPECT_NEAR(b.yaw_rate, a.yaw_rate, Tolerance(1e-14));
  EXPECT_NEAR(b.lateral_speed, a.lateral_speed, Tolerance(1e-14));
  EXPECT_NEAR(b.sideslip, a.sideslip, Tolerance(1e-14));
  EXPECT_NEAR(b.lateral_acceleration, a.lateral_acceleration, Tolerance(1e-13));
  EXPECT_NEAR(b.longitudinal_acceleration, a.longitudinal_acceleration, Tolerance(1e-13));
}

// --- Moving steering
// -------------------------------------------------------------------------------

TEST(KinematicCar, FullLockTakesLimitOverRate) {
  KinematicCar car = CarAt({.speed = kSpeed});
  car.Step({.steering = 1.0}, 3.2337 - Tolerance(0.5e-4));
  EXPECT_LT(car.state().steering, ReferenceCar().steering_limit);
  car.Step({.steering = 1.0}, 2.0 * Tolerance(0.5e-4));
  EXPECT_EQ(car.state().steering, ReferenceCar().steering_limit);
}

TEST(KinematicCar, StepsOfTwentyMillisecondsKeepTheirPromise) {
  // Compares one step of 20 ms with a hundred shorter steps. The documented error of a step is
  // below 1e-10 m at 3 m/s.
  Random random(22);
  for (int i = 0; i < 200; ++i) {
    const double from = random.Uniform(-0.48, 0.48);
    const double to = random.Uniform(-0.48, 0.48);
    const double yaw = random.Uniform(-kPi, kPi);
    const double acceleration = random.Uniform(-3.0, 3.0);
    for (const ReferencePoint reference : {kRear, kCg}) {
      SCOPED_TRACE(fmt::format("case {}: from {} to {}, yaw {}, acceleration {}", i, from, to, yaw,
                               acceleration));
      const KinematicState start{.pose = {0.0, 0.0, yaw}, .speed = kSpeed, .steering = from};
      const Command command{.steering = to, .acceleration = acceleration};
      KinematicCar once = CarAt(start, reference);
      once.Step(command, 0.02);
      KinematicCar often = CarAt(start, reference);
      for (int step = 0; step < 100; ++step) {
        often.Step(command, 0.0002);
      }
      ExpectNear(once.state().pose, often.state().pose, 1e-10);
    }
  }
}

TEST(KinematicCar, ArrivalOfTheSteeringSplitsTheStep) {
  // A step that contains the end of the steering ramp equals a step to the end of the ramp and a
  // step over the rest.
  const double to = 0.1;
  const double ramp = to / ReferenceCar().steering_rate;
  KinematicCar once = CarAt({.speed = kSpeed});
  once.Step({.steering = to}, 5.0);
  KinematicCar twice = CarAt({.speed = kSpeed});
  twice.Step({.steering = to}, ramp);
  twice.Step({.steering = to}, 5.0 - ramp);
  EXPECT_EQ(once.state().steering, to);
  ExpectNear(twice.state().pose, once.state().pose, 1e-13);
}

// --- Rest and gears
// ---------------------------------------------------------------------------------

TEST(KinematicCar, SlowsToRestAndStays) {
  // Braking from 3 m/s at 1.5 m/s^2 takes 2 s and 3 m.
  for (const int sign : {1, -1}) {
    SCOPED_TRACE(sign);
    KinematicCar car = CarAt({.speed = sign * kSpeed});
    car.Step({.acceleration = -1.5 * sign, .gear = sign}, 4.0);
    EXPECT_EQ(car.state().speed, 0.0);
    EXPECT_NEAR(car.state().pose.x, 3.0 * sign, Tolerance(1e-14));
    EXPECT_NEAR(car.state().distance, 3.0, Tolerance(1e-14));
    EXPECT_EQ(car.FullState().longitudinal_acceleration, 0.0);
  }
}

TEST(KinematicCar, LeavesRestOnlyAlongItsGear) {
  for (const int gear : {1, -1}) {
    for (const double acceleration : {1.0, -1.0, 0.0}) {
      SCOPED_TRACE(fmt::format("gear {}, acceleration {}", gear, acceleration));
      KinematicCar car = CarAt({});
      car.Step({.acceleration = acceleration, .gear = gear}, 2.0);
      const bool moves = acceleration * gear > 0.0;
      EXPECT_EQ(car.state().speed, moves ? 2.0 * acceleration : 0.0);
      EXPECT_EQ(car.state().pose.x, moves ? 2.0 * acceleration : 0.0);
      EXPECT_EQ(car.state().distance, moves ? 2.0 : 0.0);
    }
  }
}

TEST(KinematicCar, SteersWhileStanding) {
  KinematicCar car = CarAt({});
  car.Step({.steering = 0.1}, 10.0);
  EXPECT_EQ(car.state().steering, 0.1);
  EXPECT_EQ(car.state().pose, Pose2{});
  EXPECT_EQ(car.FullState().sideslip, 0.0);
}

TEST(KinematicCar, CutOfTimeDoesNotMatter) {
  Random random(23);
  for (int i = 0; i < 200; ++i) {
    const int gear = random.Below(2) == 0 ? 1 : -1;
    const KinematicState start{.speed = gear * random.Uniform(0.0, 3.0),
                               .steering = random.Uniform(-0.4, 0.4)};
    const Command command{.steering = random.Uniform(-0.4, 0.4),
                          .acceleration = random.Uniform(-2.0, 2.0),
                          .gear = gear};
    SCOPED_TRACE(fmt::format("case {}: speed {}, steering {} to {}, acceleration {}, gear {}", i,
                             start.speed, start.steering, command.steering, command.acceleration,
                             gear));
    KinematicCar coarse = CarAt(start, i % 3 == 0 ? kCg : kRear);
    KinematicCar fine = coarse;
    for (int step = 0; step < 100; ++step) {
      coarse.Step(command, 0.02);
      fine.Step(command, 0.0075);
      fine.Step(command, 0.0125);
    }
    // The tolerance covers the documented errors of a hundred steps. The car drives at up to twice
    // the speed for which the error is documented.
    ExpectNear(fine.state().pose, coarse.state().pose, 1e-8);
    EXPECT_NEAR(fine.state().speed, coarse.state().speed, Tolerance(1e-12));
    EXPECT_NEAR(fine.state().distance, coarse.state().distance, Tolerance(1e-12));
  }
}

TEST(KinematicCar, CutOfTimeDoesNotMatterWhenTheGearChangesTheDirection) {
  // The car rolls backward at 1 m/s in the forward gear while it accelerates forward, so it is at
  // rest after 1 s. After that, one step of 2 s must agree with two steps of 1 s.
  for (const int gear : {1, -1}) {
    const KinematicState start{.speed = -1.0 * gear};
    const Command command{.acceleration = 1.0 * gear, .gear = gear};
    KinematicCar once = CarAt(start);
    once.Step(command, 2.0);
    KinematicCar twice = CarAt(start);
    twice.Step(command, 1.0);
    twice.Step(command, 1.0);
    EXPECT_NEAR(twice.state().speed, once.state().speed, Tolerance(1e-14));
    EXPECT_NEAR(twice.state().pose.x, once.state().pose.x, Tolerance(1e-14));
  }
}

TEST(KinematicCar, NeverRollsAgainstItsGear) {
  // The car brakes to rest over control periods in which the steering reaches its command at a
  // random time. Rounding must not carry the speed through zero, because the same command would
  // then accelerate the car.
  Random random(24);
  for (int i = 0; i < 3000; ++i) {
    const double deceleration = 0.1 * (1 + random.Below(30));
    const int gear = random.Below(2) == 0 ? 1 : -1;
    KinematicCar car = CarAt({.speed = gear * 0.1 * (1 + random.Below(30))});
    SCOPED_TRACE(
        fmt::format("case {}: speed {}, deceleration {}", i, car.state().speed, deceleration));
    for (int step = 0; step < 400; ++step) {
      car.Step({.steering = random.Uniform(-0.01, 0.01),
                .acceleration = -gear * deceleration,
                .gear = gear},
               0.1);
      ASSERT_GE(gear * car.state().speed, 0.0);
      if (car.state().speed == 0.0) {
        break;
      }
    }
    ASSERT_EQ(car.state().speed, 0.0);
  }
}

// --- The full state
// ---------------------------------------------------------------------------------

TEST(FullState, AccelerationsAreThoseOfTheCenterOfGravity) {
  // Second differences of the center of gravity's position over h = 1 ms, in the car's axes. The
  // truncation error of a second difference is h^2/12 times the fourth derivative of the position.
  // This derivative is below 10 m/s^4 for these speeds, angles and rates. The rounding error of a
  // second difference is 4 * 1e-16 * 5 m/h^2 = 2e-9 m/s^2.
  constexpr double kH = 1e-3;
  Random random(25);
  for (int i = 0; i < 100; ++i) {
    const double steering = random.Uniform(-0.4, 0.4);
    const KinematicState start{.pose = {0.5, -0.3, random.Uniform(-kPi, kPi)},
                               .speed = random.Uniform(1.0, 3.0),
                               .steering = steering};
    const Command command{.steering = i % 2 == 0 ? steering + random.Uniform(0.05, 0.08) : steering,
                          .acceleration = random.Uniform(-2.0, 2.0)};
    for (const ReferencePoint reference : {kRear, kCg}) {
      SCOPED_TRACE(fmt::format("case {}: yaw {}, speed {}, steering {} to {}, acceleration {}, {}",
                               i, start.pose.yaw, start.speed, steering, command.steering,
                               command.acceleration, reference == kCg ? "cg" : "rear"));
      KinematicCar car = CarAt(start, reference);
      const auto cg = [&] { return ToWorld(car.FullState().pose, {1.4, 0.0}); };
      const Vec2 before = cg();
      car.Step(command, kH);
      const VehicleState state = car.FullState();
      const Vec2 now = cg();
      car.Step(command, kH);
      const Vec2 after = cg();
      const Vec2 acceleration = (after - 2.0 * now + before) / (kH * kH);
      const Vec2 velocity = (after - before) / (2.0 * kH);
      const double tolerance = Tolerance(kH * kH / 12.0 * 10.0 + 1e-8);
      const Vec2 ahead = Direction(state.pose.yaw);
      EXPECT_NEAR(state.longitudinal_acceleration, acceleration.dot(ahead), tolerance);
      EXPECT_NEAR(state.lateral_acceleration, acceleration.dot(LeftNormal(ahead)), tolerance);
      EXPECT_NEAR(state.speed, velocity.dot(ahead), tolerance);
      EXPECT_NEAR(state.lateral_speed, velocity.dot(LeftNormal(ahead)), tolerance);
      EXPECT_NEAR(state.sideslip, std::atan2(state.lateral_speed, state.speed), Tolerance(1e-14));
      EXPECT_EQ(state.steering, state.steering_actuator);
      EXPECT_FALSE(state.wheels.has_value());
    }
  }
}

TEST(FullState, LateralAccelerationRunsSmoothlyAlongARampCutIntoPeriods) {
  // In each period a schedule commands exactly the angle that the actuator can reach by the
  // period's end. The ramp therefore ends with the period, to rounding, and the wheels never rest.
  // Along the ramp, a_y = v^2 tan(delta)/L + l_g v omega/(L cos^2 delta) rises by at most v^2/L
  // omega T/cos^2 = 0.0115 m/s^2 per period. Losing the steering rate for one period would change
  // a_y by l_g v omega/L = 0.234 m/s^2.
  const double period = 0.02;
  const VehicleParams params = ReferenceCar();
  KinematicCar car = CarAt({.speed = kSpeed});
  car.Step({.steering = 1.0}, period);
  double previous = car.FullState().lateral_acceleration;
  for (int i = 2; i < 100; ++i) {
    car.Step({.steering = params.steering_rate * period * i}, period);
    const double now = car.FullState().lateral_acceleration;
    ASSERT_NEAR(now, previous, Tolerance(0.013)) << "period " << i;
    previous = now;
  }
}

}  // namespace
}  // namespace trackbed
