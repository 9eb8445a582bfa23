#include "trackbed/path/frenet_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

// Tolerance of a conversion to the Frenet frame and back. The
// projection has an error of 1e-10 m in the station. Derivatives with respect to the station, of a
// few units, multiply this error.
constexpr double kRoundTrip = 1e-9;

/// Returns a line, followed by clothoids and arcs to both sides. The curvature is continuous and at
/// most 0.1 1/m.
Path Bends() {
  return Path({3.0, -2.0, 0.4}, {{20.0, 0.0, 1, 0.0},
                                 {10.0, 0.0, 1, 0.01},
                                 {10.0, 0.1, 1, 0.0},
                                 {20.0, 0.1, 1, -0.01},
                                 {10.0, -0.1, 1, 0.0},
                                 {10.0, -0.1, 1, 0.01}});
}

TEST(FrenetFrame, OfALineIsTheLinesOwn) {
  const Path line({0.0, 0.0, kPi / 2.0}, {{100.0, 0.0, 1}});
  // The car is 10 m north along the line and 2 m to the left. It moves at 4 m/s along the line and
  // at 3 m/s across, so its speed is 5 m/s.
  const auto motion = FromFrenet(line, {10.0, 4.0, 0.0, 2.0, 0.75, 0.0});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->pose.x, -2.0, Tolerance(1e-12));
  EXPECT_NEAR(motion->pose.y, 10.0, Tolerance(1e-12));
  EXPECT_NEAR(motion->pose.yaw, kPi / 2.0 + std::atan(0.75), Tolerance(1e-12));
  EXPECT_NEAR(motion->speed, 5.0, Tolerance(1e-12));
  EXPECT_NEAR(motion->curvature, 0.0, Tolerance(1e-12));
  EXPECT_NEAR(motion->acceleration, 0.0, Tolerance(1e-12));
}

TEST(FrenetFrame, BesideACircleIsACircle) {
  // The car's offset is 5 m to the inside of a circle of radius 20 m. The car moves on a radius of
  // 15 m instead of 20 m, so its speed is 3/4 of the rate of its station.
  const Path circle({0.0, 0.0, 0.0}, {{100.0, 1.0 / 20.0, 1}});
  const auto motion = FromFrenet(circle, {20.0, 4.0, 1.0, 5.0, 0.0, 0.0});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->pose.x, 15.0 * std::sin(1.0), Tolerance(1e-12));
  EXPECT_NEAR(motion->pose.y, 20.0 - 15.0 * std::cos(1.0), Tolerance(1e-12));
  EXPECT_NEAR(motion->pose.yaw, 1.0, Tolerance(1e-12));
  EXPECT_NEAR(motion->curvature, 1.0 / 15.0, Tolerance(1e-12));
  EXPECT_NEAR(motion->speed, 3.0, Tolerance(1e-12));
  EXPECT_NEAR(motion->acceleration, 0.75, Tolerance(1e-12));
}

TEST(FrenetFrame, IsLeftAsItWasEntered) {
  const Path path = Bends();
  Random random(11);
  for (int i = 0; i < 1000; ++i) {
    const FrenetState state{random.Uniform(0.1, 79.9), random.Uniform(0.5, 20.0),
                            random.Uniform(-3.0, 3.0), random.Uniform(-5.0, 5.0),
                            random.Uniform(-0.4, 0.4), random.Uniform(-0.1, 0.1)};
    const auto motion = FromFrenet(path, state);
    ASSERT_TRUE(motion);
    const auto back = ToFrenet(path, *motion, {state.s - 10.0, state.s + 10.0});
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->s, state.s, Tolerance(kRoundTrip));
    EXPECT_NEAR(back->d, state.d, Tolerance(kRoundTrip));
    EXPECT_NEAR(back->d_slope, state.d_slope, Tolerance(kRoundTrip));
    EXPECT_NEAR(back->d_bend, state.d_bend, Tolerance(kRoundTrip));
    EXPECT_NEAR(back->s_rate, state.s_rate, Tolerance(kRoundTrip * 20.0));
    // The error of the acceleration is v^2 = 400 m^2/s^2 times the error of the frame.
    EXPECT_NEAR(back->s_acceleration, state.s_acceleration, Tolerance(kRoundTrip * 400.0));
    const auto again = FromFrenet(path, *back);
    ASSERT_TRUE(again);
    EXPECT_NEAR((again->pose.position() - motion->pose.position()).norm(), 0.0,
                Tolerance(kRoundTrip));
    EXPECT_NEAR(AngleDifference(again->pose.yaw, motion->pose.yaw), 0.0, Tolerance(kRoundTrip));
    EXPECT_NEAR(again->curvature, motion->curvature, Tolerance(kRoundTrip));
    EXPECT_NEAR(again->speed, motion->speed, Tolerance(kRoundTrip * 20.0));
    EXPECT_NEAR(again->acceleration, motion->acceleration, Tolerance(kRoundTrip * 400.0));
  }
}

TEST(FrenetFrame, KnowsACarAtRest) {
  // The conversion must not divide by the speed. The slope and the second derivative of the offset
  // follow from the heading and the curvature.
  const Path path = Bends();
  const MotionState rest{{20.0, 8.0, 1.0}, 0.05, 0.0, 0.0};
  const auto state = ToFrenet(path, rest);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->s_rate, 0.0);
  const auto back = FromFrenet(path, *state);
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->curvature, rest.curvature, Tolerance(kRoundTrip));
  EXPECT_NEAR(back->pose.yaw, rest.pose.yaw, Tolerance(kRoundTrip));
}

TEST(FrenetFrame, HasTheDerivativesOfTheMotionItself) {
  // The station s(t) is a cubic polynomial, and the offset d(s) is a quadratic polynomial. The test
  // computes speed, heading, curvature and acceleration from central differences over the step h.
  // The errors are h^2/6 times the third derivatives (below 50), and 1e-15/h from rounding.
  const Path path = Bends();
  const auto state_at = [](double t) {
    const double s = 12.0 + 8.0 * t + 0.5 * t * t - 0.1 * t * t * t;
    const double r = s - 10.0;
    return FrenetState{s,
                       8.0 + t - 0.3 * t * t,
                       1.0 - 0.6 * t,
                       1.0 + 0.05 * r - 0.002 * r * r,
                       0.05 - 0.004 * r,
                       -0.004};
  };
  constexpr double kStep = 1e-4;
  for (const double t : {0.3, 1.6, 2.9, 4.1}) {
    const auto at = [&](double time) { return FromFrenet(path, state_at(time)).value(); };
    const MotionState before = at(t - kStep);
    const MotionState now = at(t);
    const MotionState after = at(t + kStep);
    const Vec2 velocity = (after.pose.position() - before.pose.position()) / (2.0 * kStep);
    EXPECT_NEAR(velocity.norm(), now.speed, Tolerance(1e-6));
    EXPECT_NEAR(AngleDifference(std::atan2(velocity.y(), velocity.x()), now.pose.yaw), 0.0,
                Tolerance(1e-6));
    EXPECT_NEAR((after.pose.yaw - before.pose.yaw) / (2.0 * kStep), now.speed * now.curvature,
                Tolerance(1e-6));
    EXPECT_NEAR((after.speed - before.speed) / (2.0 * kStep), now.acceleration, Tolerance(1e-6));
  }
}

TEST(FrenetFrame, IsMirroredWithThePath) {
  const Path left({0.0, 0.0, 0.3}, {{30.0, 0.02, 1, 0.002}});
  const Path right({0.0, 0.0, -0.3}, {{30.0, -0.02, 1, -0.002}});
  const auto a = FromFrenet(left, {12.0, 5.0, 0.5, 2.0, 0.2, 0.03});
  const auto b = FromFrenet(right, {12.0, 5.0, 0.5, -2.0, -0.2, -0.03});
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(a->pose.x, b->pose.x, Tolerance(1e-12));
  EXPECT_NEAR(a->pose.y, -b->pose.y, Tolerance(1e-12));
  EXPECT_NEAR(a->curvature, -b->curvature, Tolerance(1e-12));
  EXPECT_NEAR(a->acceleration, b->acceleration, Tolerance(1e-12));
}

TEST(FrenetFrame, EndsAtTheCenterOfCurvature) {
  const Path circle({0.0, 0.0, 0.0}, {{20.0, 0.1, 1}});
  EXPECT_TRUE(FromFrenet(circle, {5.0, 3.0, 0.0, 9.99, 0.0, 0.0}));
  EXPECT_FALSE(FromFrenet(circle, {5.0, 3.0, 0.0, 10.0, 0.0, 0.0}));
  EXPECT_FALSE(FromFrenet(circle, {5.0, 3.0, 0.0, 12.0, 0.0, 0.0}));
  EXPECT_FALSE(ToFrenet(circle, {{0.0, 12.0, 0.0}, 0.0, 3.0, 0.0}, {0.0, 1.0}));
}

TEST(FrenetFrame, LooksAheadAndForwards) {
  const Path line({0.0, 0.0, 0.0}, {{20.0, 0.0, 1}});
  EXPECT_TRUE(ToFrenet(line, {{5.0, 1.0, 1.5}, 0.0, 3.0, 0.0}));
  EXPECT_FALSE(ToFrenet(line, {{5.0, 1.0, 1.6}, 0.0, 3.0, 0.0}));
  EXPECT_FALSE(ToFrenet(line, {{5.0, 1.0, kPi}, 0.0, 3.0, 0.0}));
  const Path backwards({0.0, 0.0, 0.0}, {{20.0, 0.0, -1}});
  EXPECT_FALSE(ToFrenet(backwards, {{-5.0, 1.0, 0.0}, 0.0, 3.0, 0.0}));
  EXPECT_FALSE(FromFrenet(backwards, {5.0, 3.0, 0.0, 0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace trackbed
