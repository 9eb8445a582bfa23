#include "src/planning/curves/leg_speeds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/planning/poses.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

constexpr LegLimits kLegLimits{.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5},
                               .steering_rate = 0.15,
                               .lateral = 1.0,
                               .wheelbase = 2.5};

double TimeFromRestToRest(const std::vector<Segment>& segments) {
  return LegTime(kLegLimits, LegPieces(kLegLimits, segments, 0.0), 0.0, 0.0);
}

TEST(LegSpeeds, TimeOfAStraightIsThatOfATrapezoidOfSpeed) {
  // Speeding up takes 3 s and 4.5 m, braking 2 s and 3 m; the rest of 30 m takes 7.5 s.
  EXPECT_NEAR(TimeFromRestToRest({{.length = 30.0}}), 12.5, Tolerance(1e-12));
  // Half of the way to this speed: a quarter of the length.
  EXPECT_NEAR(TimeFromRestToRest({{.length = 7.5 / 4.0}}), 2.5, Tolerance(1e-12));
}

TEST(LegSpeeds, ChangeOfDirectionIsAStop) {
  const double one = TimeFromRestToRest({{.length = 4.0}});
  const double both = TimeFromRestToRest({{.length = 4.0}, {.length = 4.0, .direction = -1}});
  EXPECT_NEAR(both, 2.0 * one, Tolerance(1e-12));
}

TEST(LegSpeeds, ArcIsDrivenAtTheLateralAcceleration) {
  const auto pieces = LegPieces(kLegLimits, {{.length = 5.0, .curvature = -0.25}}, 0.0);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_NEAR(pieces[0].speed, 2.0, Tolerance(1e-12));
}

TEST(LegSpeeds, ClothoidKeepsTheSteeringRate) {
  // From curvature -0.1 to 0.2; the wheels turn fastest per length where they are straight.
  const Segment clothoid{.length = 3.0, .curvature = -0.1, .sharpness = 0.1};
  double from = 0.0;
  for (const LegPiece& piece : LegPieces(kLegLimits, {clothoid}, 0.0)) {
    double fastest = 0.0;
    for (double d = from; d <= from + piece.length; d += 0.001) {
      const double bend = kLegLimits.wheelbase * clothoid.CurvatureAt(d);
      fastest = std::max(fastest, piece.speed * kLegLimits.wheelbase * 0.1 / (1.0 + bend * bend));
    }
    EXPECT_LE(fastest, kLegLimits.steering_rate * (1.0 + Tolerance(1e-12)));
    // The curvature changes by 0.0375 1/m within a piece: 1 + (L kappa)^2 by at most
    // 2.5^2 (0.2^2 - 0.1625^2) = 0.085.
    EXPECT_GE(fastest, kLegLimits.steering_rate * (1.0 - 0.085));
    from += piece.length;
  }
  EXPECT_NEAR(from, clothoid.length, Tolerance(1e-12));
}

TEST(LegSpeeds, KeepsTheLeastSpeedButNotAboveTheMission) {
  const Segment sharp{.length = 1.0, .sharpness = 10.0};
  EXPECT_EQ(LegPieces(kLegLimits, {sharp}, 0.5).front().speed, 0.5);
  EXPECT_EQ(LegPieces(kLegLimits, {sharp}, 5.0).front().speed, 3.0);
}

TEST(LegSpeeds, LeastTimeIsBelowTheTimeAndThatOfConstantSpeed) {
  // At the speed of its lateral acceleration, 2 m/s, the car needs 2.5 s for an arc of 5 m.
  EXPECT_NEAR(LeastLegTime(kLegLimits, {{.length = 5.0, .curvature = -0.25}}, 0.0), 2.5,
              Tolerance(1e-12));
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    std::vector<Segment> segments;
    for (int k = 0; k < 4; ++k) {
      segments.push_back({.length = random.Uniform(0.1, 9.0),
                          .curvature = random.Uniform(-0.2, 0.2),
                          .sharpness = k % 2 == 0 ? random.Uniform(-0.2, 0.2) : 0.0});
    }
    const double speed = random.Uniform(0.1, 3.0);
    const double time = LegTime(kLegLimits, LegPieces(kLegLimits, segments, speed), speed, speed);
    EXPECT_LE(LeastLegTime(kLegLimits, segments, speed), time * (1.0 + Tolerance(1e-12))) << i;
  }
}

}  // namespace
}  // namespace trackbed
