#include "trackbed/analysis/statistics.h"

#include <gtest/gtest.h>

#include <boost/math/tools/roots.hpp>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

// The ends are where the score test rejects: |passed / n - p| = z sqrt(p (1 - p) / n), solved here
// by bisection to the last bits.
TEST(WilsonInterval, IsWhereTheScoreTestRejects) {
  constexpr double kZ = 1.959963984540054;  // the normal distribution's 0.975 quantile, from tables
  for (const std::size_t count : {1U, 10U, 300U, 40000U}) {
    for (const std::size_t passed : {std::size_t{0}, count / 3, count - 1, count}) {
      const auto n = static_cast<double>(count);
      const double seen = static_cast<double>(passed) / n;
      const auto score = [&](double p) {
        return std::abs(seen - p) - kZ * std::sqrt(p * (1.0 - p) / n);
      };
      const auto root = [&](double from, double to) {
        const auto found = boost::math::tools::bisect(score, from, to,
                                                      boost::math::tools::eps_tolerance<double>());
        return 0.5 * (found.first + found.second);
      };
      const Interval interval = WilsonInterval(passed, count, 0.95);
      // Bisection stops at neighboring doubles; the closed form loses some more to cancellation.
      constexpr double kTolerance = 1e-12;
      if (passed > 0) {
        EXPECT_NEAR(interval.low, root(1e-15, seen - 1e-9), kTolerance) << passed << "/" << count;
      } else {
        EXPECT_EQ(interval.low, 0.0);
      }
      if (passed < count) {
        EXPECT_NEAR(interval.high, root(seen + 1e-9, 1.0 - 1e-15), kTolerance)
            << passed << "/" << count;
      } else {
        EXPECT_EQ(interval.high, 1.0);
      }
    }
  }
}

// Newcombe (1998), Statistics in Medicine 17, table I, method 3, to its four digits.
TEST(WilsonInterval, IsThatOfNewcombesTable) {
  const Interval many = WilsonInterval(81, 263, 0.95);
  EXPECT_NEAR(many.low, 0.2553, 5e-5);
  EXPECT_NEAR(many.high, 0.3662, 5e-5);
  const Interval few = WilsonInterval(15, 148, 0.95);
  EXPECT_NEAR(few.low, 0.0624, 5e-5);
  EXPECT_NEAR(few.high, 0.1605, 5e-5);
  const Interval none = WilsonInterval(0, 20, 0.95);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.1611, 5e-5);
  const Interval one = WilsonInterval(1, 29, 0.95);
  EXPECT_NEAR(one.low, 0.0061, 5e-5);
  EXPECT_NEAR(one.high, 0.1718, 5e-5);
}

TEST(WilsonInterval, KnowsNothingOfNoTrial) {
  EXPECT_EQ(WilsonInterval(0, 0, 0.95).low, 0.0);
  EXPECT_EQ(WilsonInterval(0, 0, 0.95).high, 1.0);
  EXPECT_THROW(WilsonInterval(2, 1, 0.95), PreconditionError);
  EXPECT_THROW(WilsonInterval(1, 2, 1.0), PreconditionError);
}

}  // namespace
}  // namespace trackbed
