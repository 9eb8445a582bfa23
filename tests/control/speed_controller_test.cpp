#include "trackbed/control/speed_controller.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/vehicle/kinematic_car.h"

namespace trackbed {
namespace {

// Rounding: a few operations on numbers below 100.
constexpr double kRounding = 1e-12;
constexpr double kPeriod = 0.02;
const SpeedControlOptions kOptions{.acceleration = 1.0, .deceleration = 1.5, .gain = 2.0};
constexpr SpeedLimits kLimits{.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};

TEST(SpeedControl, OnTheProfileIsItsOwnAcceleration) {
  const SpeedProfile profile = StopAtEnd(100.0, 0.0, kLimits);
  EXPECT_NEAR(SpeedControl(kOptions, profile, 0.0, 0.0, kPeriod), 1.0, Tolerance(kRounding));
  EXPECT_NEAR(SpeedControl(kOptions, profile, 2.0, 2.0, kPeriod), 1.0, Tolerance(kRounding));
  EXPECT_NEAR(SpeedControl(kOptions, profile, 50.0, 3.0, kPeriod), 0.0, Tolerance(kRounding));
  EXPECT_NEAR(SpeedControl(kOptions, profile, 98.5, std::sqrt(4.5), kPeriod), -1.5,
              Tolerance(kRounding));
}

TEST(SpeedControl, IsOnTheProfileAtTheEndOfEveryPeriod) {
  // The speed of the car also matches the profile in periods that contain a knot of the profile:
  // its speed begins to rise at 40 m, is constant from 42.5 m and falls from 97 m on. Each of the
  // three iterations multiplies the speed error by a T/v = 0.015, with the acceleration a, the
  // period T and the speed v. An initial error of a T = 0.03 m/s is therefore reduced to about 1e-7
  // m/s.
  const SpeedProfile profile = StopAtEnd(100.0, 2.0, kLimits, {{20.0, 40.0, 2.0}});
  for (double s = 38.0; s < 99.9; s += 0.013) {
    const double v = profile.SpeedAt(s);
    const double a = SpeedControl(kOptions, profile, s, v, kPeriod);
    const double next = s + v * kPeriod + 0.5 * a * kPeriod * kPeriod;
    EXPECT_NEAR(v + a * kPeriod, profile.SpeedAt(next), Tolerance(1e-6)) << s;
  }
}

TEST(SpeedControl, PushesTowardTheProfile) {
  const SpeedProfile profile = StopAtEnd(100.0, 0.0, kLimits);
  EXPECT_NEAR(SpeedControl(kOptions, profile, 50.0, 2.9, kPeriod), 0.2, Tolerance(kRounding));
  EXPECT_NEAR(SpeedControl(kOptions, profile, 50.0, 3.1, kPeriod), -0.2, Tolerance(kRounding));
}

TEST(SpeedControl, StaysWithinItsLimits) {
  const SpeedProfile profile = StopAtEnd(100.0, 0.0, kLimits);
  EXPECT_EQ(SpeedControl(kOptions, profile, 50.0, 0.0, kPeriod), 1.0);
  EXPECT_EQ(SpeedControl(kOptions, profile, 50.0, 30.0, kPeriod), -3.0);
}

TEST(SpeedControl, BrakesNoHarderThanTheRoadLets) {
  constexpr double kOnIce = 0.5;  // [m/s^2]
  const SpeedProfile profile = StopAtEnd(100.0, 0.0, kLimits);
  // At all stations the car is faster than the profile: before the profile brakes, while it brakes,
  // and past its end.
  for (const double s : {50.0, 98.5, 99.9, 100.5}) {
    EXPECT_EQ(SpeedControl(kOptions, profile, s, 20.0, kPeriod, kOnIce), -kOnIce) << s;
  }
}

TEST(SpeedControl, FollowsAProfileThatBrakesHardOnPurpose) {
  // The profile brakes from 8 m/s to rest within 8 m, which is 4 m/s^2. The comfortable
  // deceleration is 1.5 m/s^2.
  const SpeedProfile profile = StopAtEnd(8.0, 8.0, kLimits);
  EXPECT_NEAR(SpeedControl(kOptions, profile, 0.0, 8.0, kPeriod), -4.0, Tolerance(1e-6));
  // A car that is faster than the profile may brake 5 % harder than the profile, within the car's
  // limit. At 9 m/s instead of 8 m/s, the car covers 9/8 of the distance in a period, so the speed
  // of the profile falls by 9/8 as much.
  EXPECT_NEAR(SpeedControl(kOptions, profile, 0.0, 9.0, kPeriod), -4.2 * 9.0 / 8.0, 0.02);
  EXPECT_NEAR(SpeedControl(kOptions, profile, 0.0, 9.0, kPeriod, 4.5), -4.5, Tolerance(kRounding));
  // Beyond the end of the profile, where the car should be at rest, the car brakes at the 4 m/s^2
  // of the profile.
  EXPECT_NEAR(SpeedControl(kOptions, profile, 8.1, 1.0, kPeriod), -4.0, Tolerance(kRounding));
}

TEST(SpeedControl, FollowsAProfileThatAcceleratesHardOnPurpose) {
  // The profile accelerates from 4 to 8 m/s within 8 m, which is 3 m/s^2. The comfortable
  // acceleration is 1 m/s^2.
  const SpeedProfile profile({{0.0, 4.0}, {8.0, 8.0}, {100.0, 8.0}});
  EXPECT_NEAR(SpeedControl(kOptions, profile, 0.0, 4.0, kPeriod), 3.0, Tolerance(1e-6));
  // A car that is slower than the profile may accelerate 5 % harder than the profile.
  EXPECT_NEAR(SpeedControl(kOptions, profile, 0.0, 3.0, kPeriod), 3.15, Tolerance(kRounding));
  // Where the profile does not accelerate hard, the comfortable limit applies.
  EXPECT_EQ(SpeedControl(kOptions, profile, 50.0, 3.0, kPeriod), kOptions.acceleration);
}

TEST(SpeedControl, BrakesAfterTheEnd) {
  const SpeedProfile profile = StopAtEnd(100.0, 0.0, kLimits);
  EXPECT_EQ(SpeedControl(kOptions, profile, 100.0, 1.0, kPeriod), -1.5);
  EXPECT_EQ(SpeedControl(kOptions, profile, 120.0, 0.0, kPeriod), -1.5);
}

TEST(SpeedControl, GoesOnAfterAProfileThatEndsMoving) {
  const SpeedProfile profile({{0.0, 2.0}, {10.0, 2.0}});
  EXPECT_NEAR(SpeedControl(kOptions, profile, 20.0, 2.0, kPeriod), 0.0, Tolerance(kRounding));
  EXPECT_NEAR(SpeedControl(kOptions, profile, 20.0, 1.9, kPeriod), 0.2, Tolerance(kRounding));
}

TEST(SpeedControl, StopsTheCarAtTheEndOfItsProfile) {
  // The car obeys the commanded acceleration exactly. If the acceleration of the profile changes
  // inside a period T, the midpoint rule uses the wrong acceleration for at most T/2. Where braking
  // with the deceleration b begins, the speed error is therefore at most b T/2, and the error w of
  // v^2 is at most v b T. During braking, the speed feedback can only reduce w, so w moves the
  // stopping point by at most w/(2 b) = v T/2. In the last period, the midpoint may lie past the
  // end, where the profile commands no acceleration. The car is then less than b T^2/2 from the end
  // and slower than b T, so it moves by at most b T^2 in this period.
  for (const double period : {0.005, 0.01, 0.02, 0.05}) {
    for (const double length : {1.0, 5.0, 37.123, 100.0}) {
      for (const double start : {0.0, 1.0}) {
        SCOPED_TRACE(fmt::format("period {}, length {}, start {}", period, length, start));
        const SpeedProfile profile = StopAtEnd(length, start, kLimits);
        KinematicCar car(ReferenceCar(), ReferencePoint::kRearAxle, {.speed = start});
        for (int i = 0; i < 20000; ++i) {
          const double s = car.state().pose.x;
          car.Step({.acceleration = SpeedControl(kOptions, profile, s, car.state().speed, period)},
                   period);
        }
        EXPECT_EQ(car.state().speed, 0.0);
        EXPECT_NEAR(car.state().pose.x, length,
                    Tolerance(0.5 * kLimits.speed * period + 1.5 * 1.5 * period * period));
      }
    }
  }
}

TEST(SpeedControl, FollowsItsProfileClosely) {
  // Each knot causes a speed error of at most max(a, b) T/2, and the errors of at most two knots
  // add up.
  const SpeedProfile profile = StopAtEnd(60.0, 0.0, kLimits);
  KinematicCar car(ReferenceCar(), ReferencePoint::kRearAxle, {});
  while (car.state().pose.x < 59.0) {
    const double s = car.state().pose.x;
    ASSERT_NEAR(car.state().speed, profile.SpeedAt(s), Tolerance(2.0 * 1.5 * kPeriod / 2.0));
    car.Step({.acceleration = SpeedControl(kOptions, profile, s, car.state().speed, kPeriod)},
             kPeriod);
  }
}

TEST(SpeedControl, LeavesRestFromJustBehindTheStart) {
  // A projection may put a standing car slightly before station 0 by rounding; the car must start
  // nevertheless.
  const SpeedProfile profile = StopAtEnd(60.0, 0.0, kLimits);
  EXPECT_GT(SpeedControl(kOptions, profile, -1e-15, 0.0, kPeriod), 0.0);
}

// --- Speed over time --------------------------------------------------------------------------

TEST(SpeedAlong, EndsThePeriodAtTheWantedSpeed) {
  const Signal wanted{{{0.0, 10.0}, {1.0, 12.0}, {1.5, 8.0}}};
  // The three periods lie on one slope, across a knot, and past the last knot.
  EXPECT_NEAR(SpeedAlong(wanted, 0.5, 0.02, 2.0, 11.0, 0.02), 2.0, Tolerance(kRounding));
  EXPECT_NEAR(SpeedAlong(wanted, 0.9, 0.2, 2.0, 11.8, 0.2), (11.2 - 11.8) / 0.2,
              Tolerance(kRounding));
  EXPECT_NEAR(SpeedAlong(wanted, 3.0, 0.02, 2.0, 8.0, 0.02), 0.0, Tolerance(kRounding));
  // The car is 0.1 m/s too slow, so the gain of 2 1/s adds 0.2 m/s^2.
  EXPECT_NEAR(SpeedAlong(wanted, 3.0, 0.02, 2.0, 7.9, 0.02), 0.2, Tolerance(kRounding));
}

TEST(TimedSpeedControl, SaysNothingUnlessToldTo) {
  EXPECT_EQ(TimedSpeedControl(kOptions, 1.0, 3.0, kPeriod), std::nullopt);
  SpeedControlOptions options = kOptions;
  options.braking = Braking{.at = 2.0, .deceleration = 6.0};
  EXPECT_EQ(TimedSpeedControl(options, 1.98, 3.0, kPeriod), std::nullopt);
}

TEST(TimedSpeedControl, BrakesFromTheMomentOnHarderThanTheLimits) {
  SpeedControlOptions options = kOptions;
  options.over_time = {{{0.0, 20.0}}};
  options.braking = Braking{.at = 2.0, .deceleration = 8.0};
  EXPECT_EQ(TimedSpeedControl(options, 1.98, 20.0, kPeriod), 0.0);
  EXPECT_EQ(TimedSpeedControl(options, 2.0, 20.0, kPeriod), -8.0);
  EXPECT_EQ(TimedSpeedControl(options, 2.0 - 1e-12, 20.0, kPeriod), -8.0);  // rounding of times
  EXPECT_EQ(TimedSpeedControl(options, 60.0, 0.0, kPeriod), -8.0);
  options.braking->deceleration = 0.0;
  EXPECT_EQ(TimedSpeedControl(options, 2.5, 13.0, kPeriod), 0.0);
}

TEST(TimedSpeedControl, FollowsASpeedThatTheLimitsWouldCut) {
  SpeedControlOptions options = kOptions;
  options.over_time = {{{1.0, 20.0}, {3.0, 4.0}}};
  KinematicCar car(ReferenceCar(), ReferencePoint::kRearAxle, {.speed = 20.0});
  for (int i = 0; i < 200; ++i) {
    const double time = i * kPeriod;
    // Without an initial error the car follows to rounding, 1e-16 of 20 m/s in each of 200 periods.
    EXPECT_NEAR(car.state().speed, options.over_time.At(time), Tolerance(200 * 4e-15)) << time;
    const auto acceleration = TimedSpeedControl(options, time, car.state().speed, kPeriod);
    ASSERT_TRUE(acceleration.has_value());
    car.Step({.acceleration = *acceleration}, kPeriod);
  }
}

TEST(SpeedControl, DrivesOnACarThatRollsBack) {
  // The profile leaves s = 0 at 1 m/s^2 and reaches sqrt(0.008) m/s after 4 mm. If the car rolls
  // backward there, its speed error is the sum of this speed and the car's own speed. A controller
  // that followed the profile in reverse would brake instead.
  const SpeedProfile profile = StopAtEnd(100.0, 0.0, kLimits);
  EXPECT_GE(SpeedControl(kOptions, profile, 0.004, -0.02, kPeriod),
            2.0 * (std::sqrt(0.008) + 0.02));
  EXPECT_GE(SpeedControl(kOptions, profile, -0.004, -0.02, kPeriod), 0.9);
}

TEST(SpeedControl, BeforeTheStartDrivesAtAConstantSpeed) {
  // A car that turns round before the start: with the start's acceleration of 1 m/s^2 and the gain
  // of 2/s, its speed settles at 0.5 m/s. A faster car is braked, however far it is away.
  const SpeedProfile profile = StopAtEnd(100.0, 0.0, kLimits);
  for (const double s : {-0.5, -5.0, -50.0}) {
    EXPECT_NEAR(SpeedControl(kOptions, profile, s, 0.0, kPeriod), 1.0, Tolerance(kRounding));
    EXPECT_NEAR(SpeedControl(kOptions, profile, s, 0.5, kPeriod), 0.0, Tolerance(kRounding));
    EXPECT_NEAR(SpeedControl(kOptions, profile, s, 1.5, kPeriod), -2.0, Tolerance(kRounding));
    EXPECT_EQ(SpeedControl(kOptions, profile, s, 10.0, kPeriod), -3.0);
  }
}

}  // namespace
}  // namespace trackbed
