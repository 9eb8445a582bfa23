#include "trackbed/scenario/sampling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr SampleMethod kMethods[] = {SampleMethod::kRandom, SampleMethod::kLatinHypercube,
                                     SampleMethod::kSobol};

TEST(UnitSample, DependsOnTheSeedAlone) {
  for (const SampleMethod method : kMethods) {
    SCOPED_TRACE(ToString(method));
    const SampleSpec spec{.count = 100, .method = method, .seed = 7};
    const Eigen::MatrixXd sample = UnitSample(spec, 3);
    EXPECT_EQ(sample, UnitSample(spec, 3));
    EXPECT_NE(sample, UnitSample({.count = 100, .method = method, .seed = 8}, 3));
    // Seeds that differ only in their upper half give different samples, too.
    EXPECT_NE(sample, UnitSample({.count = 100, .method = method, .seed = 7 + (1ULL << 32U)}, 3));
    EXPECT_TRUE((sample.array() > 0.0).all());
    EXPECT_TRUE((sample.array() < 1.0).all());
    EXPECT_NE(sample.col(0), sample.col(1));
  }
}

TEST(UnitSample, LeavesOtherColumnsAsTheyWereWhenOneIsAdded) {
  for (const SampleMethod method : {SampleMethod::kRandom, SampleMethod::kLatinHypercube}) {
    const SampleSpec spec{.count = 50, .method = method, .seed = 3};
    EXPECT_EQ(UnitSample(spec, 2), UnitSample(spec, 5).leftCols(2)) << ToString(method);
  }
}

TEST(UnitSample, GoesOnWithTheSamePointsWhenThereAreMore) {
  for (const SampleMethod method : {SampleMethod::kRandom, SampleMethod::kSobol}) {
    EXPECT_EQ(UnitSample({.count = 20, .method = method}, 4),
              UnitSample({.count = 90, .method = method}, 4).topRows(20))
        << ToString(method);
  }
}

// By definition, each interval contains one point, in every column.
TEST(UnitSample, OfALatinHypercubeHasOnePointInEachInterval) {
  constexpr int kCount = 1000;
  const Eigen::MatrixXd sample =
      UnitSample({.count = kCount, .method = SampleMethod::kLatinHypercube, .seed = 11}, 4);
  for (int j = 0; j < 4; ++j) {
    std::set<int> intervals;
    for (int i = 0; i < kCount; ++i) {
      intervals.insert(static_cast<int>(sample(i, j) * kCount));
    }
    EXPECT_EQ(intervals.size(), kCount);
  }
}

// A (0, m, 2) net in base 2: each elementary interval of area 2^-m contains one of the first 2^m
// points in the first two dimensions, even after a digital shift (Niederreiter 1992).
TEST(UnitSample, OfSobolsSequenceIsANetInBaseTwo) {
  constexpr int kPower = 8;
  const Eigen::MatrixXd sample =
      UnitSample({.count = 1 << kPower, .method = SampleMethod::kSobol, .seed = 5}, 2);
  for (int across = 0; across <= kPower; ++across) {
    std::set<std::pair<int, int>> cells;
    for (int i = 0; i < sample.rows(); ++i) {
      cells.emplace(static_cast<int>(std::ldexp(sample(i, 0), across)),
                    static_cast<int>(std::ldexp(sample(i, 1), kPower - across)));
    }
    EXPECT_EQ(cells.size(), 1U << kPower) << across;
  }
}

// The Kolmogorov-Smirnov distance from the uniform distribution is below 1.63 / sqrt(n) for 99 of
// 100 seeds; the seeds are fixed.
TEST(UnitSample, OfRandomPointsIsUniform) {
  constexpr int kCount = 10000;
  for (const std::uint64_t seed : {1ULL, 2ULL, 12345678901234567890ULL}) {
    const Eigen::MatrixXd sample =
        UnitSample({.count = kCount, .method = SampleMethod::kRandom, .seed = seed}, 2);
    for (int j = 0; j < 2; ++j) {
      std::vector<double> column(sample.col(j).begin(), sample.col(j).end());
      std::sort(column.begin(), column.end());
      double distance = 0.0;
      for (int i = 0; i < kCount; ++i) {
        const double u = column[static_cast<std::size_t>(i)];
        distance = std::max({distance, std::abs(u - static_cast<double>(i) / kCount),
                             std::abs(u - static_cast<double>(i + 1) / kCount)});
      }
      EXPECT_LT(distance, 1.63 / std::sqrt(kCount));
    }
    // The correlation of independent columns is normally distributed with the standard deviation
    // 1/sqrt(n). The bound is four standard deviations.
    const Eigen::VectorXd a = sample.col(0).array() - 0.5;
    const Eigen::VectorXd b = sample.col(1).array() - 0.5;
    EXPECT_LT(std::abs(a.dot(b)) / (a.norm() * b.norm()), 4.0 / std::sqrt(kCount));
  }
}

TEST(UnitSample, RefusesBadArguments) {
  EXPECT_THROW(UnitSample({.count = 0}, 1), PreconditionError);
  EXPECT_THROW(UnitSample({.count = 1}, -1), PreconditionError);
  EXPECT_THROW(UnitSample({.count = 1}, 1001), PreconditionError);
  EXPECT_EQ(UnitSample({.count = 3}, 0).rows(), 3);
}

double NumberAt(const Distribution& distribution, double u) {
  return std::stod(Quantile(distribution, u));
}

TEST(Quantile, IsTheInverseOfTheDistributionFunction) {
  const Distribution uniform{.kind = DistributionKind::kUniform, .from = -2.0, .to = 6.0};
  EXPECT_EQ(Quantile(uniform, 0.25), "0");
  const Distribution log{.kind = DistributionKind::kLogUniform, .from = 0.01, .to = 100.0};
  EXPECT_NEAR(NumberAt(log, 0.5), 1.0, Tolerance(1e-15));
  EXPECT_NEAR(NumberAt(log, 0.25), 0.1, Tolerance(1e-15));
  const Distribution normal{.kind = DistributionKind::kNormal, .mean = 10.0, .deviation = 2.0};
  EXPECT_EQ(Quantile(normal, 0.5), "10");
  // Phi(1.959963984540054) = 0.975, from tables.
  EXPECT_NEAR(NumberAt(normal, 0.975), 10.0 + 2.0 * 1.959963984540054, Tolerance(1e-13));
}

// P(X < x | min < X < max) = (Phi(x) - Phi(min)) / (Phi(max) - Phi(min)), with Phi by std::erfc.
TEST(Quantile, OfATruncatedNormalDistributionStaysWithinItsBounds) {
  const Distribution truncated{
      .kind = DistributionKind::kNormal, .mean = 1.0, .deviation = 0.5, .min = 0.25, .max = 1.1};
  const auto phi = [](double x) { return 0.5 * std::erfc(-(x - 1.0) / 0.5 / std::sqrt(2.0)); };
  for (const double u : {1e-12, 0.1, 0.5, 0.9, 1.0 - 1e-12}) {
    const double x = NumberAt(truncated, u);
    EXPECT_GE(x, 0.25);
    EXPECT_LE(x, 1.1);
    EXPECT_NEAR((phi(x) - phi(0.25)) / (phi(1.1) - phi(0.25)), u, Tolerance(1e-12));
  }
  // The bounds are so far in the tail that probabilities round to 1.
  const Distribution far{
      .kind = DistributionKind::kNormal, .mean = 0.0, .deviation = 1.0, .min = 40.0, .max = 50.0};
  EXPECT_EQ(Quantile(far, 0.5), "40");
}

TEST(Quantile, OfIntegersIncludesBothEndsAlike) {
  const Distribution die{.kind = DistributionKind::kInteger, .from = 1.0, .to = 6.0};
  std::vector<int> counts(7);
  for (int i = 0; i < 600; ++i) {
    ++counts[std::stoul(Quantile(die, (i + 0.5) / 600.0))];
  }
  EXPECT_THAT(counts, testing::ElementsAre(0, 100, 100, 100, 100, 100, 100));
  EXPECT_EQ(Quantile(die, 1.0 - 1e-16), "6");
}

TEST(Quantile, OfStepsIncludesBothEndsAlike) {
  const Distribution steps{
      .kind = DistributionKind::kUniform, .from = 12.0, .to = 13.0, .step = 0.2};
  std::map<std::string, int> counts;
  for (int i = 0; i < 600; ++i) {
    ++counts[Quantile(steps, (i + 0.5) / 600.0)];
  }
  const std::map<std::string, int> expected{{"12", 100},   {"12.2", 100}, {"12.4", 100},
                                            {"12.6", 100}, {"12.8", 100}, {"13", 100}};
  EXPECT_EQ(counts, expected);
  EXPECT_EQ(Quantile(steps, 1.0 - 1e-16), "13");
}

TEST(Quantile, ChoosesByWeight) {
  const Distribution choice{.kind = DistributionKind::kChoice,
                            .values = {"a", "[b, c]", "d"},
                            .weights = {1.0, 0.0, 3.0}};
  EXPECT_EQ(Quantile(choice, 0.2499), "a");
  EXPECT_EQ(Quantile(choice, 0.2501), "d");
  const Distribution equal{.kind = DistributionKind::kChoice, .values = {"a", "[b, c]", "d"}};
  EXPECT_EQ(Quantile(equal, 0.5), "[b, c]");
  EXPECT_EQ(Quantile(equal, std::nextafter(1.0, 0.0)), "d");
}

}  // namespace
}  // namespace trackbed
