#include "trackbed/falsify/sequential_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

SequentialTest After(double probability, int successes, int failures) {
  // With this confidence, no likelihood ratio is high enough, so the test never stops.
  SequentialTest test(probability, 1.0 - 1e-15);
  const int trials = successes + failures;
  for (int i = 0; i < trials; ++i) {
    // Distributes failures and successes evenly, so that their ratio is the same at every trial.
    const auto due = [&](int n) { return static_cast<long>(n) * failures / trials; };
    test.Add(due(i + 1) == due(i));
  }
  return test;
}

TEST(SequentialTest, HasTheLikelihoodsOfItsDefinition) {
  // Integrates over q by Simpson's rule in 20 000 steps. The error is below 1e-9 for polynomials of
  // degree 30.
  for (const double p : {0.3, 0.9}) {
    for (const auto& [s, f] : {std::pair(0, 0), {1, 0}, {0, 1}, {20, 3}, {7, 9}}) {
      const auto integral = [&, successes = s, failures = f](double from, double to) {
        constexpr int kSteps = 20000;
        double sum = 0.0;
        for (int i = 0; i <= kSteps; ++i) {
          const double q = from + (to - from) * i / kSteps;
          const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
          sum += weight * std::pow(q / p, successes) * std::pow((1.0 - q) / (1.0 - p), failures);
        }
        return sum * (to - from) / (3.0 * kSteps);
      };
      const SequentialTest test = After(p, s, f);
      EXPECT_NEAR(std::exp(test.LogAbove()) / (integral(p, 1.0) / (1.0 - p)), 1.0, 1e-9);
      EXPECT_NEAR(std::exp(test.LogBelow()) / (integral(0.0, p) / p), 1.0, 1e-9);
    }
  }
}

/// If all n trials succeed, the likelihood ratio is L = (1 - P^(n+1))/((n + 1) (1 - P) P^n). If all
/// n trials fail, the likelihood ratio is M = (1 - (1 - P)^(n+1))/((n + 1) P (1 - P)^n).
TEST(SequentialTest, StopsWhereTheClosedFormDoes) {
  for (const auto& [probability, expected] : {std::pair(0.99, 449U), {0.95, 88U}, {0.5, 7U}}) {
    SequentialTest test(probability, 0.95);
    while (test.verdict() == ProbabilityVerdict::kUndecided) {
      test.Add(true);
    }
    EXPECT_EQ(test.verdict(), ProbabilityVerdict::kAtLeast);
    const auto above = [p = probability](double n) {
      return (1.0 - std::pow(p, n + 1.0)) / ((n + 1.0) * (1.0 - p) * std::pow(p, n));
    };
    EXPECT_EQ(test.trials(), expected);
    EXPECT_GE(above(expected), 20.0);
    EXPECT_LT(above(expected - 1.0), 20.0);
  }
  SequentialTest test(0.99, 0.95);
  // For P = 0.99 and one failure, M is (1 - 0.01^2)/(2 x 0.99 x 0.01) = 50.5.
  test.Add(false);
  EXPECT_EQ(test.verdict(), ProbabilityVerdict::kBelow);
  EXPECT_NEAR(std::exp(test.LogBelow()), (1.0 - 1e-4) / (2.0 * 0.99 * 0.01), 1e-9);
}

/// Computes the exact probability of a verdict within `trials`, from the distribution of the number
/// of successes of all tests that have not stopped yet.
struct Verdicts {
  double at_least = 0.0;
  double below = 0.0;
};

Verdicts ExactVerdicts(double claimed, double confidence, double truth, int trials) {
  std::vector<double> alive{1.0};  // indexed by the number of successes
  Verdicts verdicts;
  const double enough = -std::log1p(-confidence);
  for (int n = 1; n <= trials; ++n) {
    std::vector<double> next(alive.size() + 1, 0.0);
    for (std::size_t s = 0; s < alive.size(); ++s) {
      next[s] += alive[s] * (1.0 - truth);
      next[s + 1] += alive[s] * truth;
    }
    for (std::size_t s = 0; s < next.size(); ++s) {
      if (next[s] == 0.0) {
        continue;
      }
      const double a = static_cast<double>(s);
      const double f = static_cast<double>(n) - a;
      const double likelihood = a * std::log(claimed) + f * std::log1p(-claimed);
      const double beta = std::lgamma(a + 1.0) + std::lgamma(f + 1.0) - std::lgamma(n + 2.0);
      // The probability that q exceeds P after s successes in n trials is P(Binomial(n + 1, P) <=
      // s) = I_{1-P}(n + 1 - s, s + 1).
      double above = 0.0;
      double term = std::pow(1.0 - claimed, n + 1);
      for (std::size_t k = 0; k <= s; ++k) {
        above += term;
        term *= (n + 1.0 - static_cast<double>(k)) / (static_cast<double>(k) + 1.0) * claimed /
                (1.0 - claimed);
      }
      if (std::log(above) + beta - likelihood - std::log1p(-claimed) >= enough) {
        verdicts.at_least += next[s];
        next[s] = 0.0;
      } else if (std::log1p(-std::min(above, 1.0)) + beta - likelihood - std::log(claimed) >=
                 enough) {
        verdicts.below += next[s];
        next[s] = 0.0;
      }
    }
    alive = std::move(next);
  }
  return verdicts;
}

TEST(SequentialTest, ErrsExactlyAsSeldomAsItSays) {
  // If the true pass rate equals the claimed pass rate, either verdict counts as wrong.
  for (const double claimed : {0.5, 0.8, 0.9}) {
    for (const double confidence : {0.8, 0.95}) {
      const Verdicts verdicts = ExactVerdicts(claimed, confidence, claimed, 300);
      EXPECT_LE(verdicts.at_least, 1.0 - confidence) << claimed << " at " << confidence;
      EXPECT_LE(verdicts.below, 1.0 - confidence) << claimed << " at " << confidence;
      EXPECT_GT(verdicts.below, 0.1 * (1.0 - confidence));
    }
  }
}

TEST(SequentialTest, ErrsAsSeldomInStreams) {
  constexpr int kStreams = 4000;
  constexpr int kTrials = 400;
  constexpr double kConfidence = 0.9;
  std::mt19937 random(1970);
  // The pass rates for which a verdict is wrong: at most the claimed rate for `kAtLeast`, at least
  // the claimed rate for `kBelow`.
  for (const auto& [truth, wrong] :
       {std::pair(0.9, ProbabilityVerdict::kAtLeast), std::pair(0.87, ProbabilityVerdict::kAtLeast),
        std::pair(0.9, ProbabilityVerdict::kBelow), std::pair(0.93, ProbabilityVerdict::kBelow)}) {
    std::bernoulli_distribution succeeds(truth);
    int errors = 0;
    int verdicts = 0;
    for (int stream = 0; stream < kStreams; ++stream) {
      SequentialTest test(0.9, kConfidence);
      for (int i = 0; i < kTrials && test.verdict() == ProbabilityVerdict::kUndecided; ++i) {
        test.Add(succeeds(random));
      }
      errors += test.verdict() == wrong ? 1 : 0;
      verdicts += test.verdict() != ProbabilityVerdict::kUndecided ? 1 : 0;
    }
    // The bound on the rate of wrong verdicts is three standard deviations above the level: 0.1 + 3
    // sqrt(0.1 x 0.9/4000) = 0.114.
    EXPECT_LE(errors, kStreams * 0.1142) << truth;
    EXPECT_GT(verdicts, kStreams / 100) << truth;
  }
}

TEST(SequentialTest, EndsSoonFarFromTheClaim) {
  std::mt19937 random(1947);
  std::bernoulli_distribution succeeds(0.5);
  for (int stream = 0; stream < 100; ++stream) {
    SequentialTest test(0.9, 0.95);
    while (test.verdict() == ProbabilityVerdict::kUndecided && test.trials() < 200) {
      test.Add(succeeds(random));
    }
    EXPECT_EQ(test.verdict(), ProbabilityVerdict::kBelow);
    const std::size_t trials = test.trials();
    test.Add(true);  // a verdict is final
    EXPECT_EQ(test.trials(), trials);
  }
}

TEST(SequentialTest, CountsManyTrials) {
  const SequentialTest test = After(0.99, 99000, 1000);
  // If the true pass rate equals the claimed rate, neither likelihood ratio becomes high. By
  // Laplace's method, both likelihood ratios are about sqrt(pi/2 P (1 - P)/n)/(1 - P). For pass
  // rates below the claimed rate, the divisor 1 - P is P instead.
  const double width = std::sqrt(std::acos(-1.0) / 2.0 * 0.99 * 0.01 / 1e5);
  EXPECT_NEAR(std::exp(test.LogAbove()) * 0.01 / width, 1.0, 0.03);
  EXPECT_NEAR(std::exp(test.LogBelow()) * 0.99 / width, 1.0, 0.03);
}

TEST(SequentialTest, RefusesWhatIsNoProbability) {
  EXPECT_THROW(SequentialTest(1.0, 0.95), PreconditionError);
  EXPECT_THROW(SequentialTest(0.0, 0.95), PreconditionError);
  EXPECT_THROW(SequentialTest(0.9, 1.0), PreconditionError);
}

}  // namespace
}  // namespace trackbed
