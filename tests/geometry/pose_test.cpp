#include "trackbed/geometry/pose.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/geometry/random.h"
#include "tests/support/expect_near.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace pose_test {

// Rounding error of a few operations on coordinates below 100 m; each operation has an error of 100
// x 2^-52.
constexpr double kRounding = 1e-13;

Pose2 RandomPose(Random& random) {
  return {random.Uniform(-50.0, 50.0), random.Uniform(-50.0, 50.0), random.Uniform(-4.0, 4.0)};
}

TEST(Direction, OfNinetyDegreesIsPlusY) {
  EXPECT_NEAR((Direction(kPi / 2.0) - Vec2{0.0, 1.0}).norm(), 0.0, Tolerance(1e-16));
}

TEST(LeftNormal, PlusXIsPlusY) {
  EXPECT_EQ(LeftNormal({1.0, 0.0}), Vec2(0.0, 1.0));
  EXPECT_EQ(LeftNormal({0.0, 1.0}), Vec2(-1.0, 0.0));
}

TEST(Cross, IsPositiveToTheLeft) {
  EXPECT_EQ(Cross({1.0, 0.0}, {0.0, 2.0}), 2.0);
  EXPECT_EQ(Cross({0.0, 2.0}, {1.0, 0.0}), -2.0);
}

TEST(ToWorld, TurnsAndShifts) {
  // The frame is at (10, 20) and faces +y. The point is 1 m ahead of the frame and 2 m to the left.
  const Vec2 p = ToWorld({10.0, 20.0, kPi / 2.0}, {1.0, 2.0});
  EXPECT_NEAR(p.x(), 8.0, Tolerance(kRounding));
  EXPECT_NEAR(p.y(), 21.0, Tolerance(kRounding));
}

TEST(ToLocal, InvertsToWorld) {
  Random random(31);
  for (int i = 0; i < 200; ++i) {
    const Pose2 X_WA = RandomPose(random);
    const Vec2 p_AQ = RandomPose(random).position();
    EXPECT_NEAR((ToLocal(X_WA, ToWorld(X_WA, p_AQ)) - p_AQ).norm(), 0.0, Tolerance(kRounding));
  }
}

TEST(Compose, IsFirstOneThenTheOther) {
  ExpectNear(Compose({1.0, 2.0, kPi / 2.0}, {3.0, 0.0, 0.25}), {1.0, 5.0, kPi / 2.0 + 0.25},
             kRounding);
}

TEST(Compose, IsAssociativeAndMovesPoints) {
  Random random(32);
  for (int i = 0; i < 200; ++i) {
    const Pose2 a = RandomPose(random);
    const Pose2 b = RandomPose(random);
    const Pose2 c = RandomPose(random);
    ExpectNear(Compose(Compose(a, b), c), Compose(a, Compose(b, c)), kRounding);
    EXPECT_NEAR(
        (ToWorld(Compose(a, b), c.position()) - ToWorld(a, ToWorld(b, c.position()))).norm(), 0.0,
        Tolerance(kRounding));
  }
}

TEST(Compose, DoesNotWrapTheYaw) {
  EXPECT_EQ(Compose({0.0, 0.0, 3.0}, {0.0, 0.0, 3.0}).yaw, 6.0);
}

TEST(MoveOnArc, OfNoTurnIsALine) {
  ExpectNear(MoveOnArc({1.0, 2.0, 0.5}, 10.0, 0.0),
             {1.0 + 10.0 * std::cos(0.5), 2.0 + 10.0 * std::sin(0.5), 0.5}, kRounding);
  ExpectNear(MoveOnArc({1.0, 2.0, 0.0}, -10.0, 0.0), {-9.0, 2.0, 0.0}, kRounding);
}

TEST(MoveOnArc, OfAQuarterTurnIsAQuarterCircle) {
  const double r = 7.0;
  ExpectNear(MoveOnArc({}, r * kPi / 2.0, kPi / 2.0), {r, r, kPi / 2.0}, kRounding);
  ExpectNear(MoveOnArc({}, r * kPi / 2.0, -kPi / 2.0), {r, -r, -kPi / 2.0}, kRounding);
  // In reverse with the wheels turned left, the car moves backward to the left, and its heading
  // turns right.
  ExpectNear(MoveOnArc({}, -r * kPi / 2.0, -kPi / 2.0), {-r, r, -kPi / 2.0}, kRounding);
}

TEST(MoveOnArc, FullCircleComesBack) {
  const Pose2 end = MoveOnArc({3.0, 4.0, 1.0}, 2.0 * kPi * 10.0, 2.0 * kPi);
  ExpectNear(end, {3.0, 4.0, 1.0 + 2.0 * kPi}, kRounding);
}

TEST(MoveOnArc, SlipTurnsTheDirectionOfMotion) {
  // With a slip angle of 90 degrees, the frame keeps its heading and moves sideways.
  ExpectNear(MoveOnArc({}, 5.0, 0.0, kPi / 2.0), {0.0, 5.0, 0.0}, kRounding);
  Random random(33);
  for (int i = 0; i < 100; ++i) {
    const double W = random.Uniform(0.01, 1.0);
    const double beta = random.Uniform(-0.5, 0.5);
    // The speed is v = 1 m/s, and the duration is t = 6 s.
    ExpectNear(MoveOnArc({}, 6.0, W * 6.0, beta),
               {(std::sin(W * 6.0 + beta) - std::sin(beta)) / W,
                -(std::cos(W * 6.0 + beta) - std::cos(beta)) / W, W * 6.0},
               kRounding);
  }
}

TEST(MoveOnArc, DoesNotDependOnTheSteps) {
  Random random(34);
  for (int i = 0; i < 200; ++i) {
    const Pose2 start = RandomPose(random);
    const double distance = random.Uniform(-50.0, 50.0);
    const double turn = random.Uniform(-6.0, 6.0);
    const double slip = random.Uniform(-0.5, 0.5);
    const double share = random.Uniform(0.0, 1.0);
    SCOPED_TRACE(fmt::format("case {}: distance {}, turn {}, slip {}, share {}", i, distance, turn,
                             slip, share));
    const Pose2 middle = MoveOnArc(start, share * distance, share * turn, slip);
    ExpectNear(MoveOnArc(middle, (1.0 - share) * distance, (1.0 - share) * turn, slip),
               MoveOnArc(start, distance, turn, slip), kRounding);
  }
}

TEST(MoveOnArc, SmallTurnsAreAsExactAsLargeOnes) {
  // MoveOnArc uses a power series for turns below 2e-4 rad. The test compares turns below and above
  // this limit with results in long double.
  for (double turn = 1e-12; turn < 1.0; turn *= 1.7) {
    SCOPED_TRACE(turn);
    const long double t = turn;
    const Pose2 end = MoveOnArc({}, 1.0, turn);
    const auto x = static_cast<double>(std::sin(t) / t);
    const long double half = std::sin(t / 2.0L);
    const auto y = static_cast<double>(2.0L * half * half / t);
    EXPECT_NEAR(end.x, x, Tolerance(4e-16));
    EXPECT_NEAR(end.y, y, Tolerance(4e-16 * std::max(1e-3, y) + 1e-300));
  }
}

}  // namespace pose_test
}  // namespace trackbed
