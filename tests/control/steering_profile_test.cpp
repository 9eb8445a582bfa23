#include "trackbed/control/steering_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace steering_profile_test {

// Rounding of sines of a few dozen radians, times amplitudes below 1.
constexpr double kRounding = 1e-14;

/// Times in (from, to) at which the profile changes sign, by bisection to 1e-12 s between samples 1
/// ms apart.
template <typename Options>
std::vector<double> Crossings(const Options& options, double from, double to) {
  std::vector<double> crossings;
  constexpr double kStep = 1e-3;
  for (double t = from; t + kStep < to; t += kStep) {
    double low = t;
    double high = t + kStep;
    if (SteeringAt(options, low) * SteeringAt(options, high) >= 0.0) {
      continue;
    }
    while (high - low > 1e-12) {
      const double middle = 0.5 * (low + high);
      (SteeringAt(options, low) * SteeringAt(options, middle) > 0.0 ? low : high) = middle;
    }
    crossings.push_back(0.5 * (low + high));
  }
  return crossings;
}

TEST(StepSteering, RampsAtItsRateAndStays) {
  const StepSteeringOptions step{.amplitude = -0.2, .at = 2.0, .rate = 0.5};
  EXPECT_EQ(SteeringAt(step, 0.0), 0.0);
  EXPECT_EQ(SteeringAt(step, 2.0), 0.0);
  EXPECT_NEAR(SteeringAt(step, 2.1), -0.05, Tolerance(kRounding));
  EXPECT_NEAR(SteeringAt(step, 2.4), -0.2, Tolerance(kRounding));
  EXPECT_EQ(SteeringAt(step, 100.0), -0.2);
}

TEST(StepSteering, WithoutARateJumps) {
  const StepSteeringOptions step{.amplitude = 0.2, .at = 2.0, .rate = {}};
  // A control period that ends when the step begins does not turn the wheels yet, even if its end
  // time is rounded up.
  EXPECT_EQ(SteeringAt(step, 2.0), 0.0);
  EXPECT_EQ(SteeringAt(step, 2.0 + 1e-12), 0.0);
  EXPECT_EQ(SteeringAt(step, 2.001), 0.2);
  EXPECT_EQ(SteeringAt(step, 100.0), 0.2);
}

TEST(RampSteering, RisesSlowlyToItsEnd) {
  for (const double side : {1.0, -1.0}) {
    const RampSteeringOptions ramp{.end = side * 0.1, .rate = 0.02, .at = 1.0};
    EXPECT_EQ(SteeringAt(ramp, 0.5), 0.0);
    EXPECT_NEAR(SteeringAt(ramp, 2.0), side * 0.02, Tolerance(kRounding));
    EXPECT_NEAR(SteeringAt(ramp, 4.5), side * 0.07, Tolerance(kRounding));
    EXPECT_EQ(SteeringAt(ramp, 6.5), side * 0.1);
  }
}

TEST(SineSteering, HasItsPeaksAndZeros) {
  const SineSteeringOptions sine{.amplitude = 0.04, .frequency = 0.4, .cycles = 1.5, .at = 1.0};
  EXPECT_EQ(SteeringAt(sine, 0.5), 0.0);
  EXPECT_EQ(SteeringAt(sine, 1.0), 0.0);
  // The sine has a period of 2.5 s, with peaks after a quarter, three quarters and five quarters of
  // the period.
  EXPECT_NEAR(SteeringAt(sine, 1.625), 0.04, Tolerance(kRounding));
  EXPECT_NEAR(SteeringAt(sine, 2.875), -0.04, Tolerance(kRounding));
  EXPECT_NEAR(SteeringAt(sine, 4.125), 0.04, Tolerance(kRounding));
  const std::vector<double> zeros = Crossings(sine, 1.01, 4.74);
  ASSERT_EQ(zeros.size(), 2U);
  EXPECT_NEAR(zeros[0], 2.25, Tolerance(2e-12));
  EXPECT_NEAR(zeros[1], 3.5, Tolerance(2e-12));
  // The profile ends after 3.75 s, at a zero crossing.
  EXPECT_NEAR(SteeringAt(sine, 4.75 - 1e-9), 0.0, Tolerance(0.04 * 2.0 * kPi * 0.4 * 1.1e-9));
  EXPECT_EQ(SteeringAt(sine, 4.75 + 1e-9), 0.0);
  EXPECT_EQ(SteeringAt(sine, 5.0), 0.0);
}

TEST(SineWithDwell, StaysAtItsSecondPeakForTheDwell) {
  const SineWithDwellOptions options{.amplitude = 0.1, .frequency = 0.7, .dwell = 0.5, .at = 1.0};
  const double period = 1.0 / 0.7;
  EXPECT_EQ(SteeringAt(options, 0.9), 0.0);
  EXPECT_NEAR(SteeringAt(options, 1.0 + 0.25 * period), 0.1, Tolerance(kRounding));
  const std::vector<double> zeros = Crossings(options, 1.01, 1.0 + period + 0.5 - 1e-3);
  ASSERT_EQ(zeros.size(), 1U);
  EXPECT_NEAR(zeros[0], 1.0 + 0.5 * period, Tolerance(2e-12));
  // Measures the time at -A in steps of 10 us. The sine leaves its peak as 1 - x^2/2, so it is
  // within 1e-12 of the peak for 1.4e-6/(2 pi f) = 0.3 us on either side.
  constexpr double kStep = 1e-5;
  int at_peak = 0;
  for (int i = 0; i < 300000; ++i) {
    at_peak += std::abs(SteeringAt(options, i * kStep) + 0.1) < 0.1e-12 ? 1 : 0;
  }
  EXPECT_NEAR(at_peak * kStep, 0.5, Tolerance(2.0 * kStep));
  // After the dwell the profile is that of the sine, delayed by the dwell.
  for (const double t : {2.6, 2.75, 2.9}) {
    EXPECT_NEAR(SteeringAt(options, t), 0.1 * std::sin(2.0 * kPi * 0.7 * (t - 1.5)),
                Tolerance(kRounding));
  }
  EXPECT_NEAR(SteeringAt(options, 1.5 + period - 1e-9), 0.0, Tolerance(1e-9));
  EXPECT_EQ(SteeringAt(options, 1.5 + period + 1e-9), 0.0);
}

TEST(SineWithDwell, WithoutADwellIsASine) {
  const SineWithDwellOptions dwell{.amplitude = 0.1, .frequency = 0.7, .dwell = 0.0, .at = 1.0};
  const SineSteeringOptions sine{.amplitude = 0.1, .frequency = 0.7, .cycles = 1.0, .at = 1.0};
  for (double t = 0.0; t < 3.0; t += 0.01) {
    EXPECT_NEAR(SteeringAt(dwell, t), SteeringAt(sine, t), Tolerance(kRounding)) << t;
  }
}

/// Returns the frequency phi'/(2 pi) of delta = A sin(phi(t)). phi' follows from delta and its
/// derivative: delta'^2 = A^2 phi'^2 (1 - (delta/A)^2).
double InstantaneousFrequency(const SweptSineOptions& options, double time) {
  constexpr double kStep = 1e-6;
  const double value = SteeringAt(options, time) / options.amplitude;
  const double slope = (SteeringAt(options, time + kStep) - SteeringAt(options, time - kStep)) /
                       (2.0 * kStep * options.amplitude);
  return std::abs(slope) / std::sqrt(1.0 - value * value) / (2.0 * kPi);
}

TEST(SweptSine, SweepsItsFrequency) {
  for (const auto& [f0, f1] : {std::pair(0.2, 4.0), std::pair(4.0, 0.2)}) {
    for (const Sweep sweep : {Sweep::kLinear, Sweep::kExponential}) {
      const SweptSineOptions options{.amplitude = 0.1,
                                     .start_frequency = f0,
                                     .end_frequency = f1,
                                     .duration = 10.0,
                                     .sweep = sweep,
                                     .at = 1.0};
      int looked_at = 0;
      for (double tau = 0.01; tau < 9.99; tau += 0.0173) {
        const double share = tau / options.duration;
        const double f = sweep == Sweep::kLinear ? f0 + (f1 - f0) * share
                                                 : f0 * std::exp(share * std::log(f1 / f0));
        // Near the peaks of the sine, InstantaneousFrequency divides by small numbers and loses
        // precision.
        if (std::abs(SteeringAt(options, 1.0 + tau)) < 0.09) {
          // The tolerance covers the errors of the central difference over 2 us. At both ends the
          // phase of up to 132 rad is rounded by 1.4e-14 rad, which is 2.2e-9 Hz. Rounding of the
          // sine adds the same error at 0.2 Hz, and twice this error at values for which sqrt(1 -
          // value^2) is 0.44. The truncation error of the central difference, (2 pi f h)^2/6 =
          // 1e-10, is smaller.
          EXPECT_NEAR(InstantaneousFrequency(options, 1.0 + tau), f, Tolerance(1e-8));
          ++looked_at;
        }
      }
      EXPECT_GT(looked_at, 300);
    }
  }
}

TEST(SweptSine, CrossesZeroWhereThePhaseIsAMultipleOfPi) {
  // The frequency rises linearly from 1 to 3 Hz in 2 s, so the phase is phi = 2 pi (tau + tau^2/2).
  // The profile crosses zero where tau + tau^2/2 is a multiple of 1/2.
  const SweptSineOptions options{.amplitude = 0.1,
                                 .start_frequency = 1.0,
                                 .end_frequency = 3.0,
                                 .duration = 2.0,
                                 .sweep = Sweep::kLinear,
                                 .at = 0.0};
  const std::vector<double> zeros = Crossings(options, 0.01, 1.99);
  ASSERT_EQ(zeros.size(), 7U);
  for (std::size_t k = 0; k < zeros.size(); ++k) {
    EXPECT_NEAR(zeros[k], std::sqrt(1.0 + static_cast<double>(k + 1)) - 1.0, Tolerance(2e-12));
  }
  EXPECT_EQ(SteeringAt(options, 2.5), 0.0);
  EXPECT_EQ(SteeringAt(options, -0.5), 0.0);
}

TEST(SweptSine, BetweenEqualFrequenciesIsASine) {
  for (const Sweep sweep : {Sweep::kLinear, Sweep::kExponential}) {
    const SweptSineOptions options{.amplitude = 0.1,
                                   .start_frequency = 0.5,
                                   .end_frequency = 0.5,
                                   .duration = 4.0,
                                   .sweep = sweep,
                                   .at = 0.0};
    for (double t = 0.05; t < 4.0; t += 0.1) {
      EXPECT_NEAR(SteeringAt(options, t), 0.1 * std::sin(kPi * t), Tolerance(kRounding));
    }
  }
}

}  // namespace steering_profile_test
}  // namespace trackbed
