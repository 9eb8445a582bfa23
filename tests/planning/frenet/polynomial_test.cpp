#include "trackbed/planning/frenet/polynomial.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"

namespace trackbed {
namespace {

/// Returns a motion with random position, speed and acceleration of a few units.
LineMotion AnyMotion(Random& random) {
  return {random.Uniform(-5.0, 5.0), random.Uniform(-5.0, 5.0), random.Uniform(-2.0, 2.0)};
}

/// Rounding error of sums whose largest terms c_i t^i are some hundred units.
constexpr double kRounding = 1e-11;

TEST(Polynomial, AndItsDerivativesAreTheSums) {
  const Polynomial p{{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}};
  EXPECT_EQ(p.At(0.0), 1.0);
  EXPECT_EQ(p.At(2.0), 1 + 4 + 12 + 32 + 80 + 192);
  EXPECT_EQ(p.At(2.0, 1), 2 + 12 + 48 + 160 + 480);
  EXPECT_EQ(p.At(2.0, 2), 6 + 48 + 240 + 960);
  EXPECT_EQ(p.At(2.0, 3), 24 + 240 + 1440);
  EXPECT_EQ(p.At(2.0, 4), 120 + 1440);
  EXPECT_EQ(p.At(2.0, 5), 720);
}

TEST(Polynomial, IntegratesItsJerkInClosedForm) {
  // The integral of the squared jerk over [0, T] is 36 a3^2 T + 144 a3 a4 T^2 + (192 a4^2 + 240 a3
  // a5) T^3 + 720 a4 a5 T^4 + 720 a5^2 T^5.
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const double a3 = random.Uniform(-1.0, 1.0);
    const double a4 = random.Uniform(-1.0, 1.0);
    const double a5 = random.Uniform(-1.0, 1.0);
    const double t = random.Uniform(0.5, 4.0);
    const Polynomial p{{random.Uniform(-1.0, 1.0), 2.0, -1.0, a3, a4, a5}};
    const double expected = 36 * a3 * a3 * t + 144 * a3 * a4 * t * t +
                            (192 * a4 * a4 + 240 * a3 * a5) * t * t * t +
                            720 * a4 * a5 * std::pow(t, 4) + 720 * a5 * a5 * std::pow(t, 5);
    // The terms of the sum reach 720 x 4^5 = 7e5.
    EXPECT_NEAR(p.IntegralOfSquare(3, t), expected, Tolerance(1e-15 * 1e6 * 10));
  }
}

TEST(Polynomial, IntegratesEveryOrderAsAQuadratureDoes) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Polynomial p = QuinticBetween(AnyMotion(random), AnyMotion(random), 3.0);
    for (std::size_t order = 0; order <= 5; ++order) {
      // Gauss quadrature with ten nodes is exact up to degree 19.
      const double expected = boost::math::quadrature::gauss<double, 10>::integrate(
          [&](double t) { return p.At(t, order) * p.At(t, order); }, 0.0, 3.0);
      EXPECT_NEAR(p.IntegralOfSquare(order, 3.0), expected, Tolerance(1e-11 * (1.0 + expected)));
    }
  }
}

TEST(Quintic, JoinsBothMotions) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const LineMotion from = AnyMotion(random);
    const LineMotion to = AnyMotion(random);
    const double t = random.Uniform(0.5, 8.0);
    const Polynomial p = QuinticBetween(from, to, t);
    EXPECT_EQ(p.At(0.0), from.position);
    EXPECT_EQ(p.At(0.0, 1), from.velocity);
    EXPECT_EQ(p.At(0.0, 2), from.acceleration);
    EXPECT_NEAR(p.At(t), to.position, Tolerance(kRounding));
    EXPECT_NEAR(p.At(t, 1), to.velocity, Tolerance(kRounding));
    EXPECT_NEAR(p.At(t, 2), to.acceleration, Tolerance(kRounding * 10.0));
  }
}

TEST(Quintic, FromRestToRestCostsWhatIsKnown) {
  // For a shift by D in the time T, the integral of jerk^2 is 720 D^2/T^5, and that of
  // acceleration^2 is (120/7) D^2/T^3.
  for (const double shift : {1.0, -3.5}) {
    for (const double t : {2.0, 5.0}) {
      const Polynomial p = QuinticBetween({0.4, 0.0, 0.0}, {0.4 + shift, 0.0, 0.0}, t);
      EXPECT_NEAR(p.IntegralOfSquare(3, t), 720.0 * shift * shift / std::pow(t, 5),
                  Tolerance(kRounding));
      EXPECT_NEAR(p.IntegralOfSquare(2, t), 120.0 / 7.0 * shift * shift / std::pow(t, 3),
                  Tolerance(kRounding));
    }
  }
}

TEST(Quartic, ChangesSpeedAtTheKnownCost) {
  // If the acceleration is 0 at both ends, the integral of jerk^2 is 12 dv^2/T^3, and that of
  // acceleration^2 is 1.2 dv^2/T, where dv is the change of the speed. The distance is T times the
  // mean speed.
  for (const double change : {2.0, -3.0}) {
    for (const double t : {1.5, 6.0}) {
      const Polynomial p = QuarticBetween({7.0, 4.0, 0.0}, {0.0, 4.0 + change, 0.0}, t);
      EXPECT_NEAR(p.IntegralOfSquare(3, t), 12.0 * change * change / std::pow(t, 3),
                  Tolerance(kRounding));
      EXPECT_NEAR(p.IntegralOfSquare(2, t), 1.2 * change * change / t, Tolerance(kRounding));
      EXPECT_NEAR(p.At(t), 7.0 + t * (4.0 + 0.5 * change), Tolerance(kRounding));
    }
  }
}

TEST(Quartic, JoinsBothMotionsWhereverItEnds) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const LineMotion from = AnyMotion(random);
    const LineMotion to = AnyMotion(random);
    const double t = random.Uniform(0.5, 8.0);
    const Polynomial p = QuarticBetween(from, to, t);
    EXPECT_EQ(p.At(0.0), from.position);
    EXPECT_EQ(p.At(0.0, 1), from.velocity);
    EXPECT_EQ(p.At(0.0, 2), from.acceleration);
    EXPECT_NEAR(p.At(t, 1), to.velocity, Tolerance(kRounding));
    EXPECT_NEAR(p.At(t, 2), to.acceleration, Tolerance(kRounding));
  }
}

TEST(Quartic, EndsWhereTheJerkCostsLeast) {
  // The quartic polynomial is the optimum with a free end position, so a quintic to any other end
  // has a larger cost.
  const LineMotion from{0.0, 3.0, 0.5};
  const LineMotion to{0.0, 5.0, 0.0};
  const Polynomial quartic = QuarticBetween(from, to, 4.0);
  for (const double beside : {-1.0, -0.01, 0.01, 1.0}) {
    const Polynomial quintic = QuinticBetween(from, {quartic.At(4.0) + beside, 5.0, 0.0}, 4.0);
    EXPECT_GT(quintic.IntegralOfSquare(3, 4.0), quartic.IntegralOfSquare(3, 4.0));
  }
}

}  // namespace
}  // namespace trackbed
