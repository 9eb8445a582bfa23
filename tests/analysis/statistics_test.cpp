// Tests the statistics of studies against closed forms, brute force and published tables: Wilson
// intervals (Newcombe 1998), quantiles, Student intervals, first-order sensitivity indices
// (Ishigami and Homma 1990), sign test and rank correlation (Pearson 1907).

#include "trackbed/analysis/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/scenario/sampling.h"

namespace trackbed {
namespace {

// The interval ends where the score test rejects: |passed / n - p| = z sqrt(p (1 - p) / n), solved
// here by bisection to the last bit.
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
      // Bisection stops at neighboring doubles; the closed form loses a few more digits to
      // cancellation.
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

// By definition, the fraction p of the other values lies below the quantile p. The test counts
// these values by brute force. Between two members of the sample, quantiles are interpolated
// linearly.
TEST(Quantiles, HaveTheirShareOfTheSampleBelow) {
  EXPECT_EQ(Quantiles({4.0, 1.0, 3.0, 2.0}, {0.0, 0.25, 0.5, 1.0}),
            (std::vector<double>{1.0, 1.75, 2.5, 4.0}));
  EXPECT_EQ(Quantiles({7.0}, {0.0, 0.3, 1.0}), (std::vector<double>{7.0, 7.0, 7.0}));
  std::mt19937_64 random(3);
  std::vector<double> values;
  for (int i = 0; i < 101; ++i) {
    values.push_back(static_cast<double>(random() >> 11U));
  }
  for (int percent = 0; percent <= 100; ++percent) {
    // With 101 values every percentile is one of them.
    const double quantile = Quantiles(values, {percent / 100.0}).front();
    // The rank of a percentile, such as 0.29 x 100, has a rounding error of 1e-14 ranks.
    const double slack = 1e-10 * quantile;
    EXPECT_EQ(std::count_if(values.begin(), values.end(),
                            [&](double value) { return value < quantile - slack; }),
              percent);
  }
  EXPECT_THROW(Quantiles({}, {0.5}), PreconditionError);
  EXPECT_THROW(Quantiles({1.0, std::nan("")}, {0.5}), PreconditionError);
  EXPECT_THROW(Quantiles({1.0}, {1.1}), PreconditionError);
}

// t(0.975, 3) = 3.182446 from tables; the mean of 1, 2, 4, 9 is 4, their standard deviation sqrt(38
// / 3).
TEST(EstimateMean, HasStudentsInterval) {
  const MeanEstimate estimate = EstimateMean({1.0, 2.0, 4.0, 9.0}, 0.95);
  const double half = 3.182446 * std::sqrt(38.0 / 3.0) / 2.0;
  EXPECT_EQ(estimate.count, 4U);
  EXPECT_EQ(estimate.mean, 4.0);
  EXPECT_NEAR(estimate.interval->low, 4.0 - half, 2e-6);  // seven digits of t
  EXPECT_NEAR(estimate.interval->high, 4.0 + half, 2e-6);
  EXPECT_FALSE(EstimateMean({2.0}, 0.95).interval.has_value());
}

TEST(Classify, TakesDistinctValuesOrEqualShares) {
  const Classes few = Classify({"a", "b", "a", "1"}, 3);
  EXPECT_EQ(few.of_row, (std::vector<std::size_t>{0, 1, 0, 2}));
  EXPECT_EQ(few.names, (std::vector<std::string>{"a", "b", "1"}));
  const Classes halves = Classify({"5", "1", "4", "2", "3", "6"}, 2);
  EXPECT_EQ(halves.of_row, (std::vector<std::size_t>{1, 0, 1, 0, 0, 1}));
  EXPECT_EQ(halves.names, (std::vector<std::string>{"2", "5"}));
  // Equal values share a class, and the remaining values are divided anew.
  const Classes ties = Classify({"1", "1", "1", "1", "2", "3", "4", "5"}, 4);
  EXPECT_EQ(ties.of_row, (std::vector<std::size_t>{0, 0, 0, 0, 1, 2, 3, 3}));
  // Texts have no order, so each one is a class.
  EXPECT_EQ(Classify({"1", "2", "3", "x"}, 2).names.size(), 4U);
}

std::vector<Classes> ClassesOf(const Eigen::MatrixXd& points, std::size_t most) {
  std::vector<Classes> classes;
  for (Eigen::Index column = 0; column < points.cols(); ++column) {
    std::vector<std::string> values;
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      values.push_back(ShortestText(points(row, column)));
    }
    classes.push_back(Classify(values, most));
  }
  return classes;
}

// Ishigami and Homma (1990): y = sin x1 + a sin^2 x2 + b x3^4 sin x1, x uniform from -pi to pi. The
// variance contributions are integrals in closed form.
TEST(FirstOrderIndices, AreThoseOfIshigamisFunction) {
  constexpr double kA = 7.0;
  constexpr double kB = 0.1;
  const double pi4 = std::pow(std::numbers::pi, 4);
  const double of_1 = 0.5 * std::pow(1.0 + kB * pi4 / 5.0, 2);
  const double of_2 = kA * kA / 8.0;
  const double of_1_with_3 = kB * kB * pi4 * pi4 * (1.0 / 18.0 - 1.0 / 50.0);
  const double all = of_1 + of_2 + of_1_with_3;
  const std::vector<double> truth{of_1 / all, of_2 / all, 0.0};
  for (const SampleMethod method :
       {SampleMethod::kRandom, SampleMethod::kLatinHypercube, SampleMethod::kSobol}) {
    const Eigen::MatrixXd points = UnitSample({.count = 16384, .method = method, .seed = 5}, 3);
    std::vector<double> output;
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      const auto x = [&](Eigen::Index i) {
        return (2.0 * points(row, i) - 1.0) * std::numbers::pi;
      };
      output.push_back(std::sin(x(0)) + kA * std::pow(std::sin(x(1)), 2) +
                       kB * std::pow(x(2), 4) * std::sin(x(0)));
    }
    const auto indices = FirstOrderIndices(ClassesOf(points, 64), output);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      ASSERT_TRUE(indices[i]);
      const double half = 0.5 * (indices[i]->interval.high - indices[i]->interval.low);
      // With 64 classes of width 0.098, the sensitivity index is too small by 0.098^2/12 E[f'^2]/V.
      // For x2, f' = a sin(2 x2), and the index is too small by 0.0014. Half a confidence interval
      // is 1.96 standard deviations. A fixed sample lies within four standard deviations with a
      // probability of 1 - 1/16 000.
      EXPECT_NEAR(indices[i]->index, truth[i], 0.0014 + 4.0 / 1.96 * half) << i;
      // The standard deviation of the index of 16384 samples is about sqrt(1 / 16384) = 0.008, and
      // less than twice as much for these outputs. Half a confidence interval is 1.96 standard
      // deviations, which is below 0.03.
      EXPECT_LT(half, 0.03) << i;
      EXPECT_GT(half, 0.001) << i;
    }
  }
}

// About 95 % of the intervals of 200 samples must contain the true value. The number of intervals
// that contain the true value is binomial with the mean 190 and the standard deviation 3.1, so 178
// is four standard deviations below the mean. The output y = x1 + x2 / 2 + noise, with uniform
// variables, has the variance shares 1 : 1/4 : 1/4.
TEST(FirstOrderIndices, HaveIntervalsThatHaveTheTruth) {
  constexpr int kSamples = 200;
  const std::vector<double> truth{1.0 / 1.5, 0.25 / 1.5, 0.0};
  std::vector<int> held(3);
  std::vector<double> sum(3);
  for (int sample = 0; sample < kSamples; ++sample) {
    const Eigen::MatrixXd points = UnitSample(
        {.count = 400, .method = SampleMethod::kRandom, .seed = static_cast<std::uint64_t>(sample)},
        4);
    std::vector<double> output;
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      output.push_back(1e6 + points(row, 0) + 0.5 * points(row, 1) + 0.5 * points(row, 3));
    }
    const auto indices = FirstOrderIndices(ClassesOf(points.leftCols(3), 10), output);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      sum[i] += indices[i]->index / kSamples;
      held[i] += indices[i]->interval.low <= truth[i] && truth[i] <= indices[i]->interval.high;
    }
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_GE(held[i], 178) << i;
    // With ten classes, the index of a linear effect is too small by 1 %. Half the width of a
    // confidence interval is below 0.1. The error of the mean of 200 indices is this width divided
    // by sqrt(200) = 14.
    EXPECT_NEAR(sum[i], 0.99 * truth[i], 0.01) << i;
  }
}

TEST(FirstOrderIndices, AreNoneOfWhatDoesNotVary) {
  const Classes classes = Classify({"a", "b", "a", "b"}, 2);
  EXPECT_FALSE(FirstOrderIndices({classes}, {0.1, 0.1, 0.1, 0.1})[0].has_value());
  EXPECT_FALSE(FirstOrderIndices({Classify({"a", "b", "c", "d"}, 4)}, {1, 2, 3, 4})[0].has_value());
  EXPECT_FALSE(FirstOrderIndices({Classify({}, 4)}, {})[0].has_value());
  // The output takes one value in each class, so the classes explain all of its variance.
  EXPECT_EQ(FirstOrderIndices({classes}, {1.0, 2.0, 1.0, 2.0})[0]->index, 1.0);
  EXPECT_THROW(FirstOrderIndices({classes}, {1.0}), PreconditionError);
}

// The expected tail is summed from binomial coefficients as integers.
TEST(ComparePairs, HasTheExactSignTest) {
  for (const int pairs : {1, 2, 7, 20}) {
    for (int higher = 0; higher <= pairs; ++higher) {
      std::vector<double> a(static_cast<std::size_t>(pairs) + 3, 1.0);  // three pairs are equal
      std::vector<double> b = a;
      for (int i = 0; i < pairs; ++i) {
        b[static_cast<std::size_t>(i)] += i < higher ? 2.0 : -1.0;
      }
      double tail = 0.0;
      double coefficient = 1.0;
      for (int k = 0; k <= std::min(higher, pairs - higher); ++k) {
        tail += coefficient;
        coefficient = coefficient * (pairs - k) / (k + 1);
      }
      const PairedDifference compared = ComparePairs(a, b, 0.95);
      EXPECT_NEAR(compared.sign_test, std::min(1.0, 2.0 * tail / std::pow(2.0, pairs)), 1e-14);
      EXPECT_EQ(compared.higher, static_cast<std::size_t>(higher));
      EXPECT_EQ(compared.lower, static_cast<std::size_t>(pairs - higher));
      EXPECT_EQ(compared.equal, 3U);
    }
  }
  const PairedDifference moved = ComparePairs({1.0, 2.0, 3.0}, {2.0, 4.0, 6.0}, 0.95);
  EXPECT_EQ(moved.mean.mean, 2.0);
  EXPECT_EQ(moved.median, 2.0);
  EXPECT_EQ(ComparePairs({1.0}, {1.0}, 0.95).sign_test, 1.0);
  EXPECT_THROW(ComparePairs({1.0}, {}, 0.95), PreconditionError);
}

// The squared rank differences of the ten pairs sum to 194, so rho is 1 - 6 * 194/(10 (100 - 1)).
TEST(CorrelateRanks, IsSpearmans) {
  const std::vector<double> a{106, 100, 86, 101, 99, 103, 97, 113, 112, 110};
  const std::vector<double> b{7, 27, 2, 50, 28, 29, 20, 12, 6, 17};
  const RankCorrelation correlation = CorrelateRanks(a, b, 0.95).value();
  EXPECT_NEAR(correlation.rho, -29.0 / 165.0, 1e-14);
  EXPECT_LT(correlation.interval.low, correlation.rho);
  EXPECT_GT(correlation.interval.high, correlation.rho);
  // The two equal values share the mean of their ranks, so rho is 4.5/sqrt(4.5 * 5).
  EXPECT_NEAR(CorrelateRanks({1, 2, 2, 3}, {1, 2, 3, 4}, 0.95)->rho, std::sqrt(0.9), 1e-14);
  // Any strictly increasing relation has rho = 1, whatever its shape.
  const RankCorrelation rising =
      CorrelateRanks({1, 2, 3, 4, 5}, {1, 10, 11, 12, 1e6}, 0.95).value();
  EXPECT_NEAR(rising.rho, 1.0, 1e-14);
  EXPECT_NEAR(rising.interval.low, 1.0, 1e-6);  // atanh(1 - rounding) is 17 to 19
  EXPECT_LT(CorrelateRanks({1, 2, 3, 4}, {4, 3, 2, 1}, 0.95)->rho, -1.0 + 1e-14);
}

TEST(CorrelateRanks, IsNoneOfWhatDoesNotVary) {
  EXPECT_FALSE(CorrelateRanks({1, 1, 1, 1}, {1, 2, 3, 4}, 0.95).has_value());
  EXPECT_FALSE(CorrelateRanks({1, 2, 3}, {1, 2, 3}, 0.95).has_value());
  EXPECT_FALSE(CorrelateRanks({}, {}, 0.95).has_value());
  EXPECT_THROW(CorrelateRanks({1}, {}, 0.95), PreconditionError);
  EXPECT_THROW(CorrelateRanks({1, 2, 3, NAN}, {1, 2, 3, 4}, 0.95), PreconditionError);
}

// For a bivariate normal distribution with correlation r, rho is 6/pi asin(r/2) (Pearson 1907). The
// probability that fewer than 178 of 200 intervals of 95 % contain rho is 2e-4.
TEST(CorrelateRanks, HasIntervalsThatContainTheTruth) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const double r : {0.0, 0.5, -0.9}) {
    const double truth = 6.0 / std::numbers::pi * std::asin(0.5 * r);
    int held = 0;
    for (int sample = 0; sample < 200; ++sample) {
      std::vector<double> a;
      std::vector<double> b;
      for (int i = 0; i < 60; ++i) {
        const double x = normal(random);
        a.push_back(x);
        b.push_back(std::exp(r * x + std::sqrt(1.0 - r * r) * normal(random)));
      }
      const Interval interval = CorrelateRanks(a, b, 0.95)->interval;
      held += interval.low <= truth && truth <= interval.high ? 1 : 0;
    }
    EXPECT_GE(held, 178) << r;
  }
}

}  // namespace
}  // namespace trackbed
