#include "src/recording/signal_delay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/tolerance.h"

// Tests the delay between two signals on sums of sines, for which the true delay is known.
namespace trackbed {
namespace signal_delay_test {

constexpr double kPeriod = 0.01;  // [s]

double Motion(double t) {
  return std::sin(0.7 * t) + 0.6 * std::sin(1.9 * t + 0.4) + 0.2 * std::sin(5.3 * t);
}

struct Signals {
  std::vector<double> reference;
  std::vector<double> signal;
  std::vector<bool> valid;
};

/// A signal 2 Motion(t - delay) + 0.3, with normal noise of the given standard deviation.
Signals Delayed(double delay, double noise, unsigned seed, int count = 6000) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0.0, 1.0);
  Signals signals;
  for (int i = 0; i < count; ++i) {
    const double t = kPeriod * i;
    signals.reference.push_back(Motion(t));
    signals.signal.push_back(2.0 * Motion(t - delay) + 0.3 + noise * error(random));
    signals.valid.push_back(true);
  }
  return signals;
}

std::optional<SignalDelay> Find(const Signals& signals) {
  return FindDelay(signals.reference, signals.signal, signals.valid, kPeriod);
}

TEST(SignalDelay, IsFoundWithoutNoise) {
  for (const double delay : {-0.9, -0.123, 0.0, 0.004, 0.36, 0.77}) {
    const auto found = Find(Delayed(delay, 0.0, 1));
    ASSERT_TRUE(found) << delay;
    // As a function of the delay, the sum of squared residuals is a parabola, except for a term of
    // fourth order. For a delay of half a sample, this term moves the minimum by the fraction
    // (omega period)^2 = 0.053^2 of a sample.
    EXPECT_NEAR(found->delay, delay, Tolerance(0.053 * 0.053 * kPeriod)) << delay;
  }
}

TEST(SignalDelay, HasTheErrorThatItStates) {
  // The mean square of n errors, each divided by its standard error, is 1 with the standard
  // deviation sqrt(2/n) if the standard errors are right; the tolerance is four times as much.
  constexpr int kDrives = 100;
  double squares = 0.0;
  for (unsigned seed = 1; seed <= kDrives; ++seed) {
    const double delay = 0.005 * seed;
    const auto found = Find(Delayed(delay, 0.5, seed));
    ASSERT_TRUE(found) << seed;
    const double error = (found->delay - delay) / found->standard_error;
    squares += error * error;
  }
  EXPECT_NEAR(squares / kDrives, 1.0, Tolerance(4.0 * std::sqrt(2.0 / kDrives)));
}

TEST(SignalDelay, IgnoresInvalidSamples) {
  Signals signals = Delayed(0.25, 0.0, 1);
  for (std::size_t i = 1000; i < 1400; ++i) {
    signals.reference[i] = 0.0;
    signals.valid[i] = false;
  }
  const auto found = Find(signals);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->delay, 0.25, Tolerance(0.053 * 0.053 * kPeriod));
}

TEST(SignalDelay, IsFoundInNoise) {
  // Noise of ten times the signal hides it in single samples, but not in means over a second, in
  // which the noise is a tenth. A normal error exceeds four standard errors once in 16000 cases.
  const auto found = Find(Delayed(0.1, 20.0, 1));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->delay, 0.1, Tolerance(4.0 * found->standard_error));
  // The least possible standard error (Cramer and Rao), with the scale 2 of the signal.
  double squares = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const double t = kPeriod * i;
    const double slope = (Motion(t + kPeriod) - Motion(t - kPeriod)) / (2.0 * kPeriod);
    squares += slope * slope;
  }
  EXPECT_LT(found->standard_error, 2.0 * 20.0 / (2.0 * std::sqrt(squares)));
}

TEST(SignalDelay, IsNoDelayOfNoise) {
  // Independent noise, smoothed over 21 samples as by local polynomials: 95 independent samples in
  // 2000, and 19 independent delays. Without the test of significance, the best of these delays
  // explains a tenth of the signal in most cases.
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> error(0.0, 1.0);
    const auto noise = [&] {
      std::vector<double> white;
      for (int i = 0; i < 2020; ++i) {
        white.push_back(error(random));
      }
      std::vector<double> smooth;
      for (std::size_t i = 0; i + 20 < white.size(); ++i) {
        double sum = 0.0;
        for (std::size_t k = 0; k <= 20; ++k) {
          sum += white[i + k];
        }
        smooth.push_back(sum);
      }
      return smooth;
    };
    Signals signals{noise(), noise(), std::vector<bool>(2000, true)};
    const auto found = FindDelay(signals.reference, signals.signal, signals.valid, kPeriod);
    EXPECT_FALSE(found) << seed << ": " << found->delay << ", " << found->standard_error;
  }
}

TEST(SignalDelay, IsUnknownWhereTheSignalsDoNotTell) {
  EXPECT_FALSE(Find(Delayed(0.1, 400.0, 1)));     // mostly noise
  EXPECT_FALSE(Find(Delayed(1.6, 0.0, 1)));       // beyond kMaxSignalDelay
  EXPECT_FALSE(Find(Delayed(0.1, 0.0, 1, 300)));  // too short
  // A delayed ramp is the same ramp plus a constant.
  Signals ramp;
  for (int i = 0; i < 6000; ++i) {
    ramp.reference.push_back(0.01 * i);
    ramp.signal.push_back(0.01 * i - 0.2);
    ramp.valid.push_back(true);
  }
  const auto found = Find(ramp);
  EXPECT_TRUE(!found || found->standard_error > std::abs(found->delay));
}

}  // namespace signal_delay_test
}  // namespace trackbed
