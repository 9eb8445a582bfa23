#include "trackbed/core/angle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

TEST(WrapAngle, KeepsWhatIsInRange) {
  for (const double angle : {0.0, 1e-300, -3.0, 3.0, kPi, std::nextafter(-kPi, 0.0)}) {
    EXPECT_EQ(WrapAngle(angle), angle);
  }
}

TEST(WrapAngle, ExcludesMinusPi) {
  EXPECT_EQ(WrapAngle(-kPi), kPi);
  EXPECT_EQ(WrapAngle(3.0 * kPi), kPi);
  EXPECT_EQ(WrapAngle(-3.0 * kPi), kPi);
}

TEST(WrapAngle, JustBeyondPiComesOutAtTheOtherEnd) {
  const double beyond = std::nextafter(kPi, 4.0);
  EXPECT_LT(WrapAngle(beyond), -3.14);
  EXPECT_GT(WrapAngle(beyond), -kPi);
}

TEST(WrapAngle, TakesOffWholeTurns) {
  Random random(71);
  for (int i = 0; i < 1000; ++i) {
    const double angle = random.Uniform(-3.1, 3.1);
    const int turns = random.Below(2001) - 1000;
    const double wound = angle + turns * 2.0 * kPi;
    // The sum in this test and WrapAngle ("within 1 ulp") each round by up to 2^-52 |wound|.
    EXPECT_NEAR(WrapAngle(wound), angle, Tolerance(std::ldexp(std::abs(wound), -51) + 1e-15));
    EXPECT_GT(WrapAngle(wound), -kPi);
    EXPECT_LE(WrapAngle(wound), kPi);
  }
}

TEST(WrapAngle, OfNoNumberIsNan) {
  EXPECT_TRUE(std::isnan(WrapAngle(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(WrapAngle(std::numeric_limits<double>::infinity())));
  EXPECT_TRUE(std::isnan(WrapAngle(-std::numeric_limits<double>::infinity())));
}

TEST(AngleDifference, IsTheShortWayRound) {
  EXPECT_NEAR(AngleDifference(3.1, -3.1), 6.2 - 2.0 * kPi, Tolerance(1e-15));
  EXPECT_NEAR(AngleDifference(-3.1, 3.1), 2.0 * kPi - 6.2, Tolerance(1e-15));
  EXPECT_EQ(AngleDifference(1.0, 0.25), 0.75);
}

TEST(AngleDifference, IsSignedSoOneSidedComparisonsLie) {
  // A signed difference far to the right is "smaller" than any tolerance: always take the absolute
  // value.
  EXPECT_LT(AngleDifference(0.0, 3.0), 1e-9);
  EXPECT_GT(std::abs(AngleDifference(0.0, 3.0)), 1e-9);
  // Subtracting angles on both sides of +-pi without wrapping gives an error of a full turn.
  EXPECT_GT(std::abs(3.14159 - -3.14159), 6.0);
  EXPECT_LT(std::abs(AngleDifference(3.14159, -3.14159)), 1e-5);
}

TEST(AngleDifference, OfOppositeAnglesIsPi) {
  EXPECT_EQ(AngleDifference(kPi, 0.0), kPi);
  EXPECT_EQ(AngleDifference(0.0, kPi), kPi);
}

}  // namespace
}  // namespace trackbed
