// Tests the search for limit cycles on signals whose content is known in closed form.

#include "src/analysis/oscillation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "src/analysis/steering_metrics.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/run.h"
#include "trackbed/analysis/verdict.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace oscillation_test {

constexpr double kPeriod = 0.02;  // [s]

std::vector<double> Sampled(double duration, const std::function<double(double)>& of) {
  std::vector<double> values;
  for (double t = 0.0; t < duration; t += kPeriod) {
    values.push_back(of(t));
  }
  return values;
}

std::vector<Wave> Waves(const std::vector<double>& signal) {
  return FindWaves(signal, signal, kPeriod, false);
}

const Wave& Largest(const std::vector<Wave>& waves) {
  return *std::max_element(waves.begin(), waves.end(),
                           [](const Wave& a, const Wave& b) { return a.amplitude < b.amplitude; });
}

/// Returns the damped oscillation exp(-zeta omega t) sin(omega_d t) with 1 Hz.
std::vector<double> Decay(double zeta) {
  const double damped = 2.0 * kPi;
  const double omega = damped / std::sqrt(1.0 - zeta * zeta);
  return Sampled(40.0,
                 [=](double t) { return std::exp(-zeta * omega * t) * std::sin(damped * t); });
}

TEST(FindWaves, FindsASineWithItsAmplitudeAndFrequency) {
  for (const double frequency : {0.3, 1.0, 2.7, 6.0}) {
    const std::vector<Wave> waves =
        Waves(Sampled(60.0, [=](double t) { return 0.1 * std::sin(2.0 * kPi * frequency * t); }));
    ASSERT_FALSE(waves.empty()) << frequency;
    // The mean over 4 cycles of a product with a phase error of half a sample in 16 per cycle errs
    // by 1 - cos(pi/16) = 2 %. The frequency has the error of one sample in at least 18 cycles.
    EXPECT_NEAR(Largest(waves).amplitude, 0.1, Tolerance(0.003)) << frequency;
    EXPECT_NEAR(Largest(waves).frequency, frequency, Tolerance(0.012 * frequency)) << frequency;
  }
}

TEST(FindWaves, FindsSawingAndGrowingWaves) {
  const auto square = [](double t) { return std::fmod(2.5 * t, 1.0) < 0.5 ? 0.5 : -0.5; };
  // The fundamental wave of a square wave, which is found together with its harmonics.
  EXPECT_GT(Largest(Waves(Sampled(12.0, square))).amplitude, 0.5);
  EXPECT_FALSE(Waves(Decay(-0.02)).empty());
}

TEST(FindWaves, TellsAWaveThatDecaysFromOneThatLasts) {
  // Half of the amplitude after 4 cycles is the damping ratio 0.0276.
  EXPECT_TRUE(Waves(Decay(0.04)).empty());
  EXPECT_FALSE(Waves(Decay(0.015)).empty());
}

TEST(FindWaves, FindsNothingInStepsAndRamps) {
  EXPECT_THAT(Waves(Sampled(60.0, [](double t) { return t > 20.0 && t < 40.0 ? 0.2 : 0.0; })),
              testing::IsEmpty());
  EXPECT_THAT(Waves(Sampled(60.0, [](double t) { return 0.01 * t * t; })), testing::IsEmpty());
  EXPECT_THAT(Waves(Sampled(60.0, [](double) { return 0.3; })), testing::IsEmpty());
}

// A fit that does not reproduce a step of the command at a cusp leaves a wave before the step.
TEST(FindWaves, FindsNothingWhereTheCommandIsConstantBeforeAStep) {
  const auto wave = [](double t) { return t < 6.4 ? 0.003 * std::sin(2.0 * kPi * 2.8 * t) : 0.0; };
  const auto step = [&](double t) { return t < 5.2 ? 0.2 : 0.2 + 2.0 * wave(t); };
  EXPECT_THAT(FindWaves(Sampled(30.0, wave), Sampled(30.0, step), kPeriod, false),
              testing::IsEmpty());
  EXPECT_FALSE(FindWaves(Sampled(30.0, wave), Sampled(30.0, wave), kPeriod, false).empty());
}

TEST(FindWaves, FindsALimitCycleAmongRandomInputs) {
  const std::vector<double> wave = Sampled(30.0, [](double t) { return std::sin(2.0 * kPi * t); });
  EXPECT_FALSE(FindWaves(wave, wave, kPeriod, true).empty());
}

TEST(FindWaves, FindsNothingInTheResponseOfDampedLoopsToNoise) {
  // After four cycles, an oscillation with a damping ratio of 0.2 has exp(-2 pi 0.2 4) = 0.7 % of
  // its amplitude. Each of the 20 runs lasts for 60 cycles.
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  for (int run = 0; run < 20; ++run) {
    double angle = 0.0;
    double rate = 0.0;
    const double omega = 2.0 * kPi;
    const std::vector<double> signal = Sampled(60.0, [&](double) {
      rate += kPeriod * (omega * omega * (noise(random) - angle) - 2.0 * 0.2 * omega * rate);
      return angle += kPeriod * rate;
    });
    EXPECT_THAT(FindWaves(signal, signal, kPeriod, true), testing::IsEmpty()) << run;
  }
}

/// Returns the signal one second earlier, smoothed by a lag of 0.3 s, with the gain 1.3.
std::vector<double> Foreseen(const std::function<double(double)>& of) {
  double value = of(0.0);
  return Sampled(60.0, [&](double t) {
    value += kPeriod / 0.3 * (of(t + 1.0) - value);
    return 1.3 * value;
  });
}

TEST(UnexplainedCommand, RemovesASlalomOfThePath) {
  const auto path = [](double t) { return 0.1 * std::sin(2.0 * kPi * 0.3 * t); };
  const LoopSignals signals{.period = kPeriod,
                            .command = Foreseen(path),
                            .foreseen = {Sampled(60.0, path)},
                            .unforeseen = {}};
  // The steering command is a wave with an amplitude of 0.1 rad. The sum of two filters with
  // different phases can have any amplitude and phase at one frequency. The remaining error is the
  // transient at the start of the lag.
  ASSERT_FALSE(Waves(signals.command).empty());
  for (const Wave& wave : FindWaves(UnexplainedCommand(signals), signals.command, kPeriod, false)) {
    EXPECT_LT(wave.amplitude, Tolerance(1e-3));
  }
}

TEST(UnexplainedCommand, KeepsALimitCycleOnASlalom) {
  const auto path = [](double t) { return 0.1 * std::sin(2.0 * kPi * 0.3 * t); };
  LoopSignals signals{.period = kPeriod,
                      .command = Foreseen(path),
                      .foreseen = {Sampled(60.0, path)},
                      .unforeseen = {}};
  for (std::size_t i = 0; i < signals.command.size(); ++i) {
    signals.command[i] += 0.05 * std::sin(2.0 * kPi * kPeriod * static_cast<double>(i));
  }
  const std::vector<Wave> waves =
      FindWaves(UnexplainedCommand(signals), signals.command, kPeriod, false);
  ASSERT_FALSE(waves.empty());
  EXPECT_NEAR(Largest(waves).amplitude, 0.05, Tolerance(0.005));
  EXPECT_NEAR(Largest(waves).frequency, 1.0, Tolerance(0.04));
}

TEST(UnexplainedCommand, RemovesTheResponseToKnownNoise) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.0, 0.05);
  const std::vector<double> noise = Sampled(60.0, [&](double) { return normal(random); });
  std::vector<double> command;
  double lagged = 0.0;
  for (const double value : noise) {
    lagged += kPeriod / 0.2 * (value - lagged);
    command.push_back(-0.5 * lagged - 0.2 * value);
  }
  const LoopSignals signals{
      .period = kPeriod, .command = command, .foreseen = {}, .unforeseen = {noise}};
  double rest = 0.0;
  double all = 0.0;
  const std::vector<double> unexplained = UnexplainedCommand(signals);
  for (std::size_t i = 0; i < command.size(); ++i) {
    rest += unexplained[i] * unexplained[i];
    all += command[i] * command[i];
  }
  // The lag of 0.2 s lies between the filters of 0.16 s and 0.32 s. The best sum of these two
  // filters leaves less than 2 % of the amplitude unexplained.
  EXPECT_LT(std::sqrt(rest / all), Tolerance(0.02));
}

VehicleParams Car() {
  VehicleParams car;
  car.wheelbase = 2.5;
  car.width = 2.0;
  car.steering_rate = 0.4;
  car.steering_limit = 0.45;
  return car;
}

/// Returns the log of a car at `speed` [m/s] on a straight path with a steering command.
RunLog Straight(double speed, const std::function<double(double)>& command) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (double t = 0.0; t < 30.0; t += kPeriod) {
    LogRow row;
    row.state.time = t;
    row.state.speed = speed;
    row.command.steering = command(t);
    row.tracking = Projection{.s = speed * t};
    log.rows.push_back(row);
  }
  return log;
}

std::function<double(double)> Sine(double amplitude, double frequency) {
  return [=](double t) { return amplitude * std::sin(2.0 * kPi * frequency * t); };
}

TEST(ToleratedAmplitude, IsTheSmallerOfRateAndSway) {
  // At 1 Hz, the amplitude limit is a fifth of a yaw rate of 0.4 rad/s. At 0.2 Hz and 20 m/s, the
  // limit is a lateral motion of 0.1 m, for which a kinematic car steers by 0.1 m L omega^2/v^2.
  EXPECT_NEAR(ToleratedAmplitude(Car(), 1.0, 5.0), 0.08 / (2.0 * kPi), Tolerance(1e-12));
  const double omega = 2.0 * kPi * 0.2;
  EXPECT_NEAR(ToleratedAmplitude(Car(), 0.2, 20.0), 0.1 * 2.5 * omega * omega / 400.0,
              Tolerance(1e-12));
  VehicleParams loose = Car();
  loose.steering_response.backlash = 0.1;
  EXPECT_EQ(ToleratedAmplitude(loose, 1.0, 5.0), 0.05);
}

TEST(MeasureOscillation, ReportsWhatExceedsTheTolerance) {
  const auto amplitude = [](double size) {
    return MeasureOscillation(Straight(5.0, Sine(size, 1.0)), Plan{}, Car())->amplitude;
  };
  EXPECT_NEAR(amplitude(0.1), 0.1, Tolerance(0.01));
  EXPECT_GT(amplitude(0.016), 0.0);  // The tolerance at 1 Hz is 0.0127 rad.
  EXPECT_EQ(amplitude(0.010), 0.0);
}

TEST(MeasureOscillation, EndsAtTheFirstContact) {
  RunLog log = Straight(5.0, [](double t) { return t > 5.0 ? Sine(0.1, 1.0)(t) : 0.0; });
  EXPECT_GT(MeasureOscillation(log, Plan{}, Car())->amplitude, 0.0);
  log.contact_time = 6.0;
  EXPECT_EQ(MeasureOscillation(log, Plan{}, Car())->amplitude, 0.0);
}

// A replanner makes a new plan every half second, and the command jumps at each change.
TEST(MeasureOscillation, IgnoresJumpsAtChangesOfPlan) {
  RunLog log = Straight(5.0, [](double t) { return 0.1 * (2.0 * t - std::floor(2.0 * t + 1e-9)); });
  RunLog sine = Straight(5.0, Sine(0.1, 1.3));
  EXPECT_GT(MeasureOscillation(log, Plan{}, Car())->amplitude, 0.0);
  for (int i = 1; i < 60; ++i) {
    log.changes.push_back({0.5 * i - 1e-9, 0.0, Plan{}});
    sine.changes.push_back({0.5 * i - 1e-9, 0.0, Plan{}});
  }
  EXPECT_EQ(MeasureOscillation(log, Plan{}, Car())->amplitude, 0.0);
  // One of 25 steps of the sine is missing, which changes its amplitude by 4 % at most.
  EXPECT_NEAR(MeasureOscillation(sine, Plan{}, Car())->amplitude, 0.1, Tolerance(0.014));
}

TEST(MeasureOscillation, IsOnlyOfRunsWithAPathAndOfCarsThatMove) {
  EXPECT_EQ(MeasureOscillation(Straight(0.0, Sine(0.1, 1.0)), Plan{}, Car())->amplitude, 0.0);
  RunLog log = Straight(5.0, Sine(0.1, 1.0));
  for (LogRow& row : log.rows) {
    row.tracking.reset();
  }
  EXPECT_FALSE(MeasureOscillation(log, Plan{}, Car()));
}

TEST(MeasureOscillation, IsFoundWithShortAndLongControlPeriods) {
  for (const double period : {0.001, 0.005, 0.05}) {
    RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
    for (double t = 0.0; t < 20.0; t += period) {
      LogRow row;
      row.state.time = t;
      row.state.speed = 5.0;
      row.command.steering = Sine(0.1, 1.5)(t);
      row.tracking = Projection{};
      log.rows.push_back(row);
    }
    const OscillationMetrics found = *MeasureOscillation(log, Plan{}, Car());
    EXPECT_NEAR(found.amplitude, 0.1, Tolerance(0.01)) << period;
    EXPECT_NEAR(found.frequency.value_or(0.0), 1.5, Tolerance(0.06)) << period;
  }
}

TEST(SteeringReversals, CountsTurnsBackByMoreThanTheGap) {
  // The gap is 0.45/180 = 0.0025 rad. A sine of 1 Hz turns back twice per second, and first after
  // a quarter of a cycle: 60 times in 30 s.
  EXPECT_NEAR(SteeringReversals(Straight(5.0, Sine(0.1, 1.0)), Car()), 2.0, Tolerance(0.01));
  EXPECT_EQ(SteeringReversals(Straight(5.0, Sine(0.0012, 1.0)), Car()), 0.0);
  EXPECT_EQ(SteeringReversals(Straight(5.0, [](double t) { return 0.01 * t; }), Car()), 0.0);
}

class CalmFollower : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Laws, CalmFollower,
                         testing::Values("rear_axle_feedback", "stanley", "lqr", "preview"),
                         [](const auto& law) { return law.param; });

// On two fillets that meet, the wheels turn at their full rate three times, with pauses that are as
// long. Each pause has the same small corrections, which a fit of the steps alone repeats as waves.
TEST_P(CalmFollower, DoesNotOscillateOnFilletsThatMeet) {
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: fillets\n"
      "mission: {speed: 2, waypoints: [[0, 0], [60, 0], [60, 30], [120, 30]]}\n"
      "plan: {method: fillet}\ndrive: {plants: [kinematic]}\ncontrol: {method: " +
          GetParam() + "}\n",
      "fillets.yaml", "");
  const RunResult result = RunScenario(scenario);
  ASSERT_EQ(result.metrics.size(), 1U);
  ASSERT_TRUE(result.metrics[0].oscillation);
  EXPECT_EQ(result.metrics[0].oscillation->amplitude, 0.0);
}

/// Returns the verdict on a car whose steering oscillates by 0.25 rad at 2 Hz.
Verdict JudgeOscillating(const Expectations& expect) {
  PlantMetrics metrics{.plant = "mujoco"};
  metrics.tracking = TrackingMetrics{.corridor = 2.0};
  metrics.oscillation = OscillationMetrics{.amplitude = 0.25,
                                           .frequency = 2.0,
                                           .from_t = 3.0,
                                           .to_t = 9.5,
                                           .rate = 3.14,
                                           .sway = 0.0625};
  metrics.steering_rate_limit = 0.4;
  return Judge(expect, {metrics}, {});
}

TEST(Verdict, FailsARunThatOscillatesUnlessAnExpectationAllowsIt) {
  EXPECT_THAT(
      JudgeOscillating({}).failures,
      testing::ElementsAre(
          "mujoco: the steering command oscillates by 0.25 rad to each side at 2 Hz without "
          "decaying between t = 3 s and 9.5 s (default check; an expectation on "
          "oscillation.amplitude replaces it)"));
  Expectations expect;
  expect.all.metrics.push_back({"oscillation.amplitude", {}, 0.3, {}});
  const Verdict verdict = JudgeOscillating(expect);
  EXPECT_TRUE(verdict.passed);
  EXPECT_THAT(verdict.notes,
              testing::ElementsAre(
                  "mujoco: the steering oscillates at 2 Hz between t = 3 s and 9.5 s; neither the "
                  "path nor measurement noise explains it; it asks for 3.14 rad/s (785 % of the "
                  "limit) and moves the car by about 0.062 m to each side"));
}

}  // namespace oscillation_test
}  // namespace trackbed
