#include "trackbed/analysis/maneuver_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/tolerance.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/verdict.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"

// Checks every maneuver evaluation on logs with closed-form results.
namespace trackbed {
namespace {

constexpr double kStep = 0.01;  // period of all logs [s]
constexpr double kWheelbase = 2.5;
// Quantities that are linear between rows are exact except for the rounding of sums of some
// thousand terms.
constexpr double kRounding = 1e-10;

VehicleParams Car() {
  VehicleParams car;
  car.wheelbase = kWheelbase;
  car.cg_to_rear = 1.2;
  car.steering_ratio = 20.0;
  car.steering_rate = 0.5;
  car.steering_limit = 0.6;
  car.length = 4.5;
  car.width = 1.6;
  car.rear_overhang = 1.0;
  return car;
}

/// A log of `duration` [s]; `fill` sets each row's state from its time.
RunLog Log(double duration, const std::function<void(double t, LogRow& row)>& fill) {
  RunLog log{.plant = "test",
             .status = DriveStatus::kArrived,
             .rows = {},
             .changes = {},
             .configurations = Table({"t_s"})};
  for (int i = 0; i <= std::lround(duration / kStep); ++i) {
    LogRow row{};
    row.state.time = i * kStep;
    fill(row.state.time, row);
    log.rows.push_back(row);
  }
  return log;
}

ManeuverMetrics Evaluated(const ManeuverOptions& options, const RunLog& log,
                          const Plan& plan = {}) {
  return EvaluateManeuver(options, log, plan, Car());
}

double Of(const ManeuverMetrics& metrics, const char* name) {
  const auto value = metrics.Find(name);
  EXPECT_TRUE(value.has_value()) << name << ": " << metrics.missing;
  return value.value_or(std::nan(""));
}

/// A linear car in steady state: delta = L/R + K a_y, on a circle of radius R or at speed v.
void SteadyState(double lateral_acceleration, double speed, double understeer, double side,
                 VehicleState& state) {
  state.speed = speed;
  state.lateral_acceleration = side * lateral_acceleration;
  state.yaw_rate = state.lateral_acceleration / speed;
  state.steering = kWheelbase * state.yaw_rate / speed + understeer * state.lateral_acceleration;
  state.roll = 0.006 * state.lateral_acceleration;
  state.sideslip = side * 0.04 - 0.01 * state.lateral_acceleration;
}

TEST(SteadyStateCircle, GivesTheGradientsOfALinearCar) {
  constexpr double kRadius = 40.0;
  for (const double side : {1.0, -1.0}) {
    for (const double understeer : {0.003, -0.001}) {
      const RunLog log = Log(60.0, [&](double t, LogRow& row) {
        const double a_y = 0.3 + 0.08 * t;
        SteadyState(a_y, std::sqrt(a_y * kRadius), understeer, side, row.state);
      });
      const ManeuverMetrics metrics = Evaluated(SteadyStateCircleOptions{}, log);
      EXPECT_NEAR(Of(metrics, "understeer_gradient"), understeer, Tolerance(kRounding));
      const char* speed = understeer > 0.0 ? "characteristic_speed" : "critical_speed";
      const char* other = understeer > 0.0 ? "critical_speed" : "characteristic_speed";
      EXPECT_NEAR(Of(metrics, speed), std::sqrt(kWheelbase / std::abs(understeer)),
                  Tolerance(1e-5));  // half of kRounding/0.001 times 50 m/s
      EXPECT_FALSE(metrics.Find(other).has_value());
      EXPECT_NEAR(Of(metrics, "roll_gradient"), 0.006, Tolerance(kRounding));
      EXPECT_NEAR(Of(metrics, "sideslip_gradient"), -0.01, Tolerance(kRounding));
      EXPECT_NEAR(Of(metrics, "lateral_acceleration_max"), 5.1, Tolerance(kRounding));
    }
  }
}

TEST(SteadyStateCircle, CountsQuasiSteadySamplesAlone) {
  const RunLog log = Log(60.0, [&](double t, LogRow& row) {
    const double a_y = 0.3 + 0.08 * t;
    SteadyState(a_y, std::sqrt(a_y * 40.0), 0.003, 1.0, row.state);
    if (t > 40.0 && t < 41.0) {  // a swerve: 0.2 rad/s in a quarter of a second
      row.state.yaw_rate += 0.2 * std::sin(2.0 * kPi * t);
      row.state.steering = 0.5;
    }
  });
  const ManeuverMetrics metrics = Evaluated(SteadyStateCircleOptions{}, log);
  // Rows half a period apart differ little near the sine's zeros, so a few of the 4500 rows pass
  // the steady-state filter.
  EXPECT_NEAR(Of(metrics, "understeer_gradient"), 0.003, Tolerance(0.003));
}

TEST(SteadyStateCircle, SaysWhenThereIsNoGradient) {
  const RunLog log =
      Log(20.0, [&](double, LogRow& row) { SteadyState(2.0, 10.0, 0.003, 1.0, row.state); });
  const ManeuverMetrics metrics = Evaluated(SteadyStateCircleOptions{}, log);
  EXPECT_FALSE(metrics.Find("understeer_gradient").has_value());
  EXPECT_THAT(metrics.missing, testing::HasSubstr("span less than 0.5 m/s^2"));
  EXPECT_NEAR(Of(metrics, "lateral_acceleration_max"), 2.0, Tolerance(kRounding));
}

TEST(SlowlyIncreasingSteer, GivesGainAndSteeringAtThreeTenths) {
  constexpr double kSpeed = 22.0;
  constexpr double kUndersteer = 0.0025;
  const RunLog log = Log(60.0, [&](double t, LogRow& row) {
    SteadyState(0.1 * t, kSpeed, kUndersteer, -1.0, row.state);
  });
  const ManeuverMetrics metrics = Evaluated(SlowlyIncreasingSteerOptions{}, log);
  EXPECT_NEAR(Of(metrics, "understeer_gradient"), kUndersteer, Tolerance(kRounding));
  EXPECT_NEAR(Of(metrics, "yaw_rate_gain"), kSpeed / (kWheelbase + kUndersteer * kSpeed * kSpeed),
              Tolerance(1e-8));
  EXPECT_NEAR(Of(metrics, "steering_at_0_3_g"),
              (kWheelbase / (kSpeed * kSpeed) + kUndersteer) * 0.3 * 9.81, Tolerance(kRounding));
}

/// Ramps the steering from 0 to `steering` between t = 1 s and 1.1 s; half is reached at 1.05 s.
void StepSteering(double t, double steering, LogRow& row) {
  row.state.steering_actuator = steering * std::clamp((t - 1.0) / 0.1, 0.0, 1.0);
  row.state.steering = row.state.steering_actuator;
  row.command.steering = t >= 1.0 - 1e-9 ? steering : 0.0;
  row.state.speed = 25.0;
}

TEST(StepSteer, OfFirstOrder) {
  constexpr double kTau = 0.2;
  for (const double side : {1.0, -1.0}) {
    const RunLog log = Log(6.0, [&](double t, LogRow& row) {
      StepSteering(t, side * 0.05, row);
      const double share = t > 1.05 ? 1.0 - std::exp(-(t - 1.05) / kTau) : 0.0;
      row.state.yaw_rate = side * 0.3 * share;
      row.state.lateral_acceleration = side * 7.0 * share;
      row.state.sideslip = -side * 0.02 * share;
    });
    const ManeuverMetrics metrics = Evaluated(StepSteerOptions{}, log);
    // Between rows h apart, linear interpolation of the decaying part 0.1 of the response errs by
    // the fraction h^2/(8 tau^2). Divided by the slope 0.1/tau of the response, this error becomes
    // an error of 6e-5 s in the response time.
    const double response = kTau * std::log(10.0);
    EXPECT_NEAR(Of(metrics, "yaw_rate_response_time"), response, Tolerance(7e-5));
    EXPECT_NEAR(Of(metrics, "lateral_acceleration_response_time"), response, Tolerance(7e-5));
    // The mean over the last second deviates by tau e^(-3.95/tau) = 5e-10.
    EXPECT_NEAR(Of(metrics, "yaw_rate_steady"), side * 0.3, Tolerance(1e-9));
    EXPECT_NEAR(Of(metrics, "yaw_rate_gain"), 6.0, Tolerance(1e-7));
    EXPECT_NEAR(Of(metrics, "yaw_rate_overshoot"), 0.0, Tolerance(1e-8));
    EXPECT_EQ(Of(metrics, "speed"), 25.0);
    // The actuator turns at its full rate in 10 of the 500 control periods in 4.99 s.
    EXPECT_NEAR(metrics.steering_saturated_fraction, 10.0 / 500.0, Tolerance(1.1 / 500.0));
  }
}

TEST(StepSteer, OfSecondOrder) {
  constexpr double kOmega = 6.0;
  constexpr double kZeta = 0.5;
  const double damped = kOmega * std::sqrt(1.0 - kZeta * kZeta);
  const RunLog log = Log(9.0, [&](double t, LogRow& row) {
    StepSteering(t, 0.05, row);
    const double u = t - 1.05;
    const double share =
        u > 0.0 ? 1.0 - std::exp(-kZeta * kOmega * u) *
                            (std::cos(damped * u) + kZeta * kOmega / damped * std::sin(damped * u))
                : 0.0;
    row.state.yaw_rate = 0.3 * share;
    row.state.sideslip = -0.02 * share;
  });
  const ManeuverMetrics metrics = Evaluated(StepSteerOptions{}, log);
  const double overshoot = std::exp(-kPi * kZeta / std::sqrt(1.0 - kZeta * kZeta));
  // A row lies at most h/2 from the peak, where the parabola is lower by omega^2/2 (h/2)^2.
  EXPECT_NEAR(Of(metrics, "yaw_rate_overshoot"), overshoot,
              Tolerance(0.5 * kOmega * kOmega * 0.25 * kStep * kStep));
  EXPECT_NEAR(Of(metrics, "yaw_rate_peak_time"), kPi / damped, Tolerance(0.5 * kStep + 1e-9));
  EXPECT_NEAR(Of(metrics, "tb"), 0.02 * kPi / damped, Tolerance(0.02 * 0.51 * kStep));
}

TEST(StepSteer, WithoutAStepSaysSo) {
  EXPECT_EQ(Evaluated(StepSteerOptions{}, Log(3.0, [](double, LogRow&) {})).missing,
            "the steering angle does not change");
}

/// Steers left from 1 s on with 0.5 rad/s and right at 1.2 s, and is straight again at 2.4 s. The
/// yaw rate decays exponentially from then on; y is the lateral displacement.
RunLog SineWithDwellLog(double side, double tau, double lateral_acceleration, double duration) {
  return Log(duration, [=](double t, LogRow& row) {
    double steering = 0.0;
    if (t > 1.0 && t < 2.4) {
      steering = t < 1.2   ? 0.5 * (t - 1.0)
                 : t < 1.6 ? 0.1 - 0.5 * (t - 1.2)
                 : t < 2.2 ? -0.1
                           : -0.5 * (2.4 - t);
    }
    row.state.steering_actuator = side * steering;
    row.state.yaw_rate =
        -side * 0.6 * (t < 2.4 ? std::max(0.0, t - 1.4) : std::exp((2.4 - t) / tau));
    row.state.pose.y = t > 1.0 ? side * 0.5 * lateral_acceleration * (t - 1.0) * (t - 1.0) : 0.0;
  });
}

TEST(SineWithDwell, GivesRatiosAndDisplacement) {
  for (const double side : {1.0, -1.0}) {
    const ManeuverMetrics metrics =
        Evaluated(SineWithDwellTestOptions{}, SineWithDwellLog(side, 0.5, 4.0, 5.0));
    // The peak is on the row of the completion of steer; the times 1.00 s and 1.75 s later are
    // rows, too.
    EXPECT_NEAR(Of(metrics, "yaw_rate_ratio_1_00"), std::exp(-2.0), Tolerance(0.002));
    EXPECT_NEAR(Of(metrics, "yaw_rate_ratio_1_75"), std::exp(-3.5), Tolerance(0.002));
    EXPECT_NEAR(Of(metrics, "yaw_rate_peak"), 0.6, Tolerance(kRounding));
    const double begin = 1.0 + 5.0 * kPi / 180.0 / 20.0 / 0.5;
    const auto across = [](double t) { return 2.0 * (t - 1.0) * (t - 1.0); };
    // Linear interpolation between rows deviates by a h^2/8 at either time.
    EXPECT_NEAR(Of(metrics, "lateral_displacement"), across(begin + 1.07) - across(begin),
                Tolerance(2.0 * 4.0 * kStep * kStep / 8.0));
    EXPECT_EQ(metrics.passed, true);
  }
}

TEST(SineWithDwell, FailsWhatTurnsOnOrHardlyMoves) {
  EXPECT_EQ(Evaluated(SineWithDwellTestOptions{}, SineWithDwellLog(1.0, 2.0, 4.0, 5.0)).passed,
            false);
  // The displacement is 0.5 a (1.07 s)^2, so the required 1.83 m need an acceleration of a >= 3.2
  // m/s^2.
  EXPECT_EQ(Evaluated(SineWithDwellTestOptions{}, SineWithDwellLog(1.0, 0.5, 3.0, 5.0)).passed,
            false);
  const ManeuverMetrics cut =
      Evaluated(SineWithDwellTestOptions{}, SineWithDwellLog(1.0, 0.5, 4.0, 4.0));
  EXPECT_EQ(cut.passed, false);
  EXPECT_EQ(cut.missing, "the run ends less than 1.75 s after the completion of steering");
}

TEST(EveryManeuver, FailsACarThatTurnsOver) {
  const RunLog log = Log(3.0, [](double t, LogRow& row) {
    row.state.speed = 20.0;
    row.state.roll = t < 2.0 ? 0.7 : -0.8;  // pi/4 is in between
  });
  RunLog rolled = log;
  rolled.status = DriveStatus::kRolledOver;  // the run ended in its last row
  const std::string end = fmt::format("the car rolls over at {:.2f} s", log.rows.back().state.time);
  for (const ManeuverEntry& entry : Maneuvers()) {
    const ManeuverMetrics metrics = Evaluated(entry.defaults, log);
    EXPECT_EQ(metrics.method, entry.name);
    EXPECT_EQ(metrics.passed, false) << entry.name;
    EXPECT_THAT(metrics.missing, testing::EndsWith("the car leans by 45 degrees at 2.00 s"));
    const ManeuverMetrics over = Evaluated(entry.defaults, rolled);
    EXPECT_EQ(over.passed, false) << entry.name;
    EXPECT_THAT(over.missing, testing::EndsWith(end));
  }
}

/// A car that drives along y = `offset`, turned by `yaw`, through gates on the x axis.
ManeuverMetrics Through(const std::vector<Gate>& gates, double offset, double yaw,
                        double duration) {
  Plan plan;
  plan.gates = gates;
  return Evaluated(LaneChangeOptions{},
                   Log(duration,
                       [=](double t, LogRow& row) {
                         row.state.pose = {20.0 * t, offset, yaw};
                         row.state.speed = 20.0 - t;
                       }),
                   plan);
}

TEST(LaneChange, FindsTheSmallestMarginAndItsGate) {
  const std::vector<Gate> gates{{1, {{20.0, 0.0, 0.0}, 10.0, 2.4}},
                                {3, {{50.0, 0.3, 0.0}, 10.0, 3.0}},
                                {5, {{80.0, 0.0, 0.0}, 10.0, 3.0}}};
  const ManeuverMetrics straight = Through(gates, 0.1, 0.0, 6.0);
  EXPECT_NEAR(Of(straight, "margin_1"), 1.2 - 0.8 - 0.1, Tolerance(kRounding));
  EXPECT_NEAR(Of(straight, "margin_3"), 1.5 - 0.8 - 0.2, Tolerance(kRounding));
  EXPECT_NEAR(Of(straight, "margin_5"), 1.5 - 0.8 - 0.1, Tolerance(kRounding));
  EXPECT_EQ(Of(straight, "margin_gate"), 1.0);
  EXPECT_EQ(straight.passed, true);
  // The front end, 3.5 m ahead of the rear axle, reaches x = 15 m after 0.575 s, so the first row
  // in the gates is at 0.58 s. The rear end reaches x = 85 m after 4.3 s.
  EXPECT_NEAR(Of(straight, "entry_speed"), 19.42, Tolerance(kRounding));
  EXPECT_NEAR(Of(straight, "speed_loss"), 4.3 - 0.58, Tolerance(kStep + kRounding));
  // For a car turned by psi, the front left corner is at 3.5 sin psi + 0.8 cos psi, the rear right
  // one at -sin psi - 0.8 cos psi.
  const double psi = 0.1;
  const double left = 3.5 * std::sin(psi) + 0.8 * std::cos(psi);
  const ManeuverMetrics turned = Through(gates, 0.0, psi, 6.0);
  EXPECT_NEAR(Of(turned, "margin_5"), 1.5 - left, Tolerance(kRounding));
  EXPECT_NEAR(Of(turned, "margin"), 1.2 - left, Tolerance(kRounding));
  const ManeuverMetrics hit = Through(gates, -0.5, 0.0, 6.0);
  EXPECT_EQ(hit.passed, false);
  EXPECT_NEAR(Of(hit, "margin"), -0.1, Tolerance(kRounding));
  const ManeuverMetrics cut = Through(gates, 0.0, 0.0, 3.0);
  EXPECT_EQ(cut.passed, false);
  EXPECT_EQ(cut.missing, "the car does not pass the last gate");
}

/// Brakes at 8 m/s^2 from 24 m/s at t = 1 s on a circle of `curvature`.
RunLog BrakingLog(double curvature, double turned) {
  return Log(5.0, [=](double t, LogRow& row) {
    const double u = std::clamp(t - 1.0, 0.0, 3.0);
    VehicleState& state = row.state;
    state.speed = 24.0 - 8.0 * u;
    state.distance = 24.0 * std::min(t, 1.0) + 24.0 * u - 4.0 * u * u;
    state.yaw_rate = curvature * state.speed;
    const double yaw = curvature * state.distance;
    state.pose.x = curvature == 0.0 ? state.distance : std::sin(yaw) / curvature;
    state.pose.y = curvature == 0.0 ? 0.0 : (1.0 - std::cos(yaw)) / curvature;
    state.pose.yaw = yaw + turned * u / 3.0;
    // The lateral speed of the center of gravity if the rear axle does not slip.
    state.lateral_speed = 1.2 * state.yaw_rate;
    row.command.acceleration = t >= 1.0 - 1e-9 ? -8.0 : 0.0;
  });
}

TEST(Braking, GivesDistanceAndMeanDeceleration) {
  for (const double curvature : {0.0, 0.01, -0.02}) {
    const ManeuverMetrics metrics = Evaluated(BrakingTestOptions{}, BrakingLog(curvature, 0.0));
    // The center of gravity moves on a circle around the same center as the rear axle, so its
    // speed, distance and deceleration are larger by the same ratio.
    const double ratio = std::hypot(1.0, 1.2 * curvature);
    EXPECT_NEAR(Of(metrics, "initial_speed"), 24.0 * ratio, Tolerance(kRounding));
    // Braking is measured down to 0.05 m/s. The distance that the car drives below this speed,
    // 0.05^2/16 m, is missing. Linear interpolation deviates by a h^2/8, and chords of 0.24 m of a
    // circle of 50 m are shorter than the circle by a millionth.
    EXPECT_NEAR(Of(metrics, "distance"), 24.0 * 24.0 / 16.0 * ratio, Tolerance(3e-4));
    EXPECT_NEAR(Of(metrics, "mean_fully_developed_deceleration"), 8.0 * ratio, Tolerance(1e-4));
    EXPECT_NEAR(Of(metrics, "lateral_deviation_max"), 0.0, Tolerance(1e-8));
    // The last row before standstill may be up to a period before the end of the 3 s.
    EXPECT_NEAR(
        Of(Evaluated(BrakingTestOptions{}, BrakingLog(curvature, 0.02)), "heading_deviation_max"),
        0.02, Tolerance(0.02 * kStep / 3.0 + 1e-8));
    EXPECT_NEAR(Of(metrics, "yaw_rate_max"), 24.0 * std::abs(curvature), Tolerance(kRounding));
  }
  const ManeuverMetrics slower = Evaluated(BrakingTestOptions{.to_speed = 12.0}, BrakingLog(0, 0));
  EXPECT_NEAR(Of(slower, "distance"), (24.0 * 24.0 - 12.0 * 12.0) / 16.0, Tolerance(3e-4));
  EXPECT_EQ(Evaluated(BrakingTestOptions{}, Log(3.0, [](double, LogRow&) {})).missing,
            "the car does not brake");
}

TEST(Braking, OfACarThatSpinsEndsWhenTheCarStandsStill) {
  // The car slides straight on at 6 m/s^2 from 24 m/s while it turns, so its forward speed vanishes
  // after 0.785 s, at a speed of 19.3 m/s, and its center of gravity stops after 4 s and 48 m.
  const RunLog log = Log(6.0, [](double t, LogRow& row) {
    const double u = std::clamp(t - 1.0, 0.0, 4.0);
    const double speed = 24.0 - 6.0 * u;
    VehicleState& state = row.state;
    state.pose.yaw = 2.0 * u;
    state.speed = speed * std::cos(state.pose.yaw);
    state.lateral_speed = -speed * std::sin(state.pose.yaw);
    state.yaw_rate = u > 0.0 && u < 4.0 ? 2.0 : 0.0;
    // The rear axle is 1.2 m behind the center of gravity.
    state.pose.x =
        24.0 * std::min(t, 1.0) + 24.0 * u - 3.0 * u * u - 1.2 * std::cos(state.pose.yaw);
    state.pose.y = -1.2 * std::sin(state.pose.yaw);
    row.command.acceleration = t >= 1.0 - 1e-9 ? -6.0 : 0.0;
  });
  const ManeuverMetrics metrics = Evaluated(BrakingTestOptions{}, log);
  EXPECT_NEAR(Of(metrics, "initial_speed"), 24.0, Tolerance(kRounding));
  // The distance after 0.05 m/s, 0.05^2/12 m, is missing; linear interpolation deviates by a h^2/8.
  EXPECT_NEAR(Of(metrics, "distance"), 48.0, Tolerance(3e-4));
  EXPECT_NEAR(Of(metrics, "mean_fully_developed_deceleration"), 6.0, Tolerance(1e-4));
  EXPECT_NEAR(metrics.end, 5.0, Tolerance(0.05 / 6.0 + kStep));
}

TEST(Disturbance, GivesDeparturesAndRecovery) {
  constexpr double kTau = 0.4;
  const auto log = [&](double rest) {
    return Log(6.0, [=](double t, LogRow& row) {
      row.state.speed = 20.0;
      row.state.distance = 20.0 * t;
      row.state.pose.x = 20.0 * t;
      row.state.pose.y = t > 2.0 ? 0.3 * std::sin(kPi * (t - 2.0) / 4.0) : 0.0;
      row.state.pose.yaw = t > 2.0 ? 0.05 * std::sin(kPi * (t - 2.0) / 4.0) : 0.0;
      row.state.yaw_rate = t > 2.0 ? rest + 0.2 * std::exp((2.0 - t) / kTau) : 0.0;
    });
  };
  const ManeuverMetrics metrics = Evaluated(DisturbanceOptions{}, log(0.0));
  EXPECT_NEAR(Of(metrics, "lateral_deviation_max"), 0.3, Tolerance(kRounding));
  EXPECT_NEAR(Of(metrics, "heading_deviation_max"), 0.05, Tolerance(kRounding));
  EXPECT_NEAR(Of(metrics, "yaw_rate_deviation_max"), 0.2 * std::exp(-kStep / kTau),
              Tolerance(kRounding));
  EXPECT_NEAR(Of(metrics, "recovery_time"), kTau * std::log(10.0), Tolerance(kStep));
  const ManeuverMetrics lost = Evaluated(DisturbanceOptions{}, log(0.1));
  EXPECT_FALSE(lost.Find("recovery_time").has_value());
  EXPECT_EQ(lost.missing, "the yaw rate does not return below its bound");
}

// --- Expectations --------------------------------------------------------------------------------

PlantMetrics Measured() {
  PlantMetrics metrics;
  metrics.plant = "mujoco";
  metrics.maneuver = ManeuverMetrics{.method = "step_steer",
                                     .begin = 0.0,
                                     .end = 1.0,
                                     .steering_saturated_fraction = 0.05,
                                     .values = {{"yaw_rate_overshoot", 0.25}},
                                     .passed = true,
                                     .missing = {}};
  return metrics;
}

std::vector<std::string> Failures(const MetricExpectation& metric) {
  Expectations expect;
  expect.all.metrics.push_back(metric);
  return Judge(expect, {Measured()}, {}).failures;
}

TEST(MetricExpectations, AreJudgedByTheirPath) {
  using testing::ElementsAre;
  using testing::IsEmpty;
  const std::string overshoot = "maneuver.yaw_rate_overshoot";
  const std::string when = " between t = 0 s and 1 s";
  EXPECT_THAT(Failures({overshoot, 0.2, 0.3, {}}), IsEmpty());
  EXPECT_THAT(Failures({overshoot, {}, 0.2, {}}),
              ElementsAre("mujoco: maneuver.yaw_rate_overshoot 0.25 exceeds 0.2" + when));
  EXPECT_THAT(Failures({overshoot, 0.3, {}, {}}),
              ElementsAre("mujoco: maneuver.yaw_rate_overshoot 0.25 is below 0.3" + when));
  EXPECT_THAT(Failures({overshoot, {}, {}, "0.25"}), IsEmpty());
  EXPECT_THAT(Failures({"maneuver.passed", {}, {}, "true"}), IsEmpty());
  EXPECT_THAT(Failures({"maneuver.passed", {}, {}, "false"}),
              ElementsAre("mujoco: maneuver.passed is true instead of false" + when));
  EXPECT_THAT(Failures({"status", {}, {}, "arrived"}), IsEmpty());
  EXPECT_THAT(Failures({"status", 1.0, {}, {}}),
              ElementsAre("mujoco: status is not a number: \"arrived\""));
  EXPECT_THAT(Failures({"maneuver.yaw_rate_overshot", 1.0, {}, {}}),
              ElementsAre("mujoco: no metric 'maneuver.yaw_rate_overshot'; did you mean "
                          "'maneuver.yaw_rate_overshoot'?"));
}

TEST(Verdict, NotesSteeringThatIsLimited) {
  EXPECT_THAT(Judge({}, {Measured()}, {}).notes,
              testing::ElementsAre("mujoco: steering limited (5 % of the time)"));
  PlantMetrics free = Measured();
  free.maneuver->steering_saturated_fraction = 0.019;
  EXPECT_THAT(Judge({}, {free}, {}).notes, testing::IsEmpty());
}

TEST(DescribeManeuverMetric, KnowsTheLimitsOfStandards) {
  // The limits of ISO 19365 and FMVSS 126 are yaw rate ratios of 35 % and 20 % and a displacement
  // of 1.83 m (6 ft). ISO 3888 requires that the car stays inside the gates.
  using Relation = StandardLimit::Relation;
  const auto limit = [](const char* name) { return DescribeManeuverMetric(name)->limit; };
  ASSERT_TRUE(limit("yaw_rate_ratio_1_00"));
  EXPECT_EQ(limit("yaw_rate_ratio_1_00")->relation, Relation::kAtMost);
  EXPECT_EQ(limit("yaw_rate_ratio_1_00")->bound, 0.35);
  EXPECT_EQ(limit("yaw_rate_ratio_1_75")->bound, 0.20);
  EXPECT_EQ(limit("lateral_displacement")->relation, Relation::kAtLeast);
  EXPECT_EQ(limit("lateral_displacement")->bound, 1.83);
  EXPECT_EQ(limit("margin")->relation, Relation::kAtLeast);
  EXPECT_EQ(limit("margin")->bound, 0.0);
  EXPECT_FALSE(limit("tb"));
  EXPECT_TRUE(limit("margin")->Met(0.0));
  EXPECT_FALSE(limit("margin")->Met(-1e-9));
  EXPECT_FALSE(limit("yaw_rate_ratio_1_00")->Met(0.351));
}

}  // namespace
}  // namespace trackbed
