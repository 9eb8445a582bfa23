#include "trackbed/control/signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

const Signal kSawtooth{{{1.0, 2.0}, {2.0, 4.0}, {2.5, -1.0}}};

TEST(Signal, IsExactAtItsKnotsAndLinearBetween) {
  for (const Vec2& knot : kSawtooth.knots) {
    EXPECT_EQ(kSawtooth.At(knot.x()), knot.y());
  }
  EXPECT_EQ(kSawtooth.At(1.25), 2.5);
  EXPECT_EQ(kSawtooth.At(2.25), 1.5);
}

TEST(Signal, IsHeldOutsideItsKnots) {
  EXPECT_EQ(kSawtooth.At(-7.0), 2.0);
  EXPECT_EQ(kSawtooth.At(2.6), -1.0);
  const Signal single{{{3.0, 0.25}}};
  EXPECT_EQ(single.At(-1.0), 0.25);
  EXPECT_EQ(single.At(3.0), 0.25);
  EXPECT_EQ(single.Mean(2.0, 9.0), 0.25);
}

TEST(Signal, MeanIsTheAreaByTheWidth) {
  // The area under the signal is 2 before the first knot, 3 between the first and the second, 0.75
  // between the second and the third, and -1 behind the third knot.
  EXPECT_NEAR(kSawtooth.Mean(0.0, 3.5), (2.0 + 3.0 + 0.75 - 1.0) / 3.5, Tolerance(1e-15));
  EXPECT_NEAR(kSawtooth.Mean(1.5, 2.25), (1.75 + 0.6875) / 0.75, Tolerance(1e-15));
  EXPECT_EQ(kSawtooth.Mean(5.0, 6.0), -1.0);
  // The mean over an empty interval is the value of the signal.
  EXPECT_EQ(kSawtooth.Mean(1.25, 1.25), 2.5);
  EXPECT_EQ(kSawtooth.Mean(1.25, 1.0), 2.5);
}

TEST(Signal, MeanAgreesWithAFineSum) {
  Random random(71);
  for (int i = 0; i < 50; ++i) {
    Signal signal;
    double x = 0.0;
    for (int k = 0; k < 6; ++k) {
      x += random.Uniform(0.1, 1.0);
      signal.knots.emplace_back(x, random.Uniform(-1.0, 1.0));
    }
    const double from = random.Uniform(-1.0, 3.0);
    const double to = from + random.Uniform(0.1, 4.0);
    constexpr int kParts = 2000;
    double sum = 0.0;
    for (int k = 0; k < kParts; ++k) {
      sum += signal.At(from + (to - from) * (k + 0.5) / kParts);
    }
    // The midpoint rule is exact, except in cells that contain one of six knots. The integral over
    // a cell with a knot errs by at most c h^2/8. The change of slope is c <= 2 * 2/0.1 = 40,
    // because values between -1 and 1 are at least 0.1 apart. The cell size is h <= 4/2000 = 0.002.
    // The mean divides the sum of these errors by the width of the interval, which is at least 0.1.
    EXPECT_NEAR(signal.Mean(from, to), sum / kParts,
                Tolerance(6.0 * 40.0 * 0.002 * 0.002 / 8.0 / 0.1));
  }
}

TEST(Signal, RisesStrictlyOrNot) {
  EXPECT_TRUE(kSawtooth.IsStrictlyIncreasing());
  EXPECT_TRUE(Signal{}.IsStrictlyIncreasing());
  EXPECT_FALSE((Signal{{{1.0, 0.0}, {1.0, 0.0}}}.IsStrictlyIncreasing()));
  EXPECT_FALSE((Signal{{{1.0, 0.0}, {0.5, 0.0}}}.IsStrictlyIncreasing()));
  EXPECT_FALSE((Signal{{{std::nan(""), 0.0}}}.IsStrictlyIncreasing()));
  EXPECT_FALSE((Signal{{{0.0, std::numeric_limits<double>::infinity()}}}.IsStrictlyIncreasing()));
}

}  // namespace
}  // namespace trackbed
