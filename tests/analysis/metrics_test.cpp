// Tests metrics of runs and their judgment on artificial logs with values known in closed form.

#include "trackbed/analysis/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/tolerance.h"
#include "trackbed/analysis/verdict.h"
#include "trackbed/control/steering_controller.h"

namespace trackbed {
namespace metrics_test {

/// Returns the log of a run at `speed` with a steering angle proportional to cos(t). The car has
/// the understeer gradient `gradient` and is in steady state at all times.
RunLog Drive(double speed, double amplitude, double gradient, double wheelbase) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i <= 500; ++i) {
    LogRow row;
    row.state.time = 0.02 * i;
    row.state.speed = speed;
    row.state.distance = std::abs(speed) * row.state.time;
    row.state.steering = amplitude * std::cos(row.state.time);
    row.state.yaw_rate =
        speed * std::tan(row.state.steering) / (wheelbase + gradient * speed * speed);
    log.rows.push_back(row);
  }
  return log;
}

std::optional<double> Ratio(double speed, double amplitude, double gradient) {
  VehicleParams vehicle;
  vehicle.wheelbase = 2.5;
  return Measure(Drive(speed, amplitude, gradient, vehicle.wheelbase), Plan{}, vehicle, 0.02,
                 StationSource::kProjection)
      .yaw_rate_ratio;
}

TEST(YawRateRatio, IsThatOfTheUndersteerGradient) {
  // The tolerance covers rounding in sums of some hundred products.
  EXPECT_NEAR(*Ratio(10.0, 0.1, 0.0), 1.0, Tolerance(1e-12));
  EXPECT_NEAR(*Ratio(10.0, 0.1, 0.0025), 1.0 / 1.1, Tolerance(1e-12));
  EXPECT_NEAR(*Ratio(20.0, -0.05, -0.001), 1.0 / (1.0 - 0.001 * 400.0 / 2.5), Tolerance(1e-12));
  EXPECT_NEAR(*Ratio(-5.0, 0.1, 0.0025), 1.0 / 1.025, Tolerance(1e-12));
}

TEST(YawRateRatio, IsNotSaidOfACarThatHardlyTurned) {
  // With the steering amplitude A, the RMS yaw rate is (10 m/s)/(2.5 m) tan(A)/sqrt(2). The RMS
  // reaches the threshold of 1e-3 rad/s at A = 0.35e-3 rad.
  EXPECT_TRUE(Ratio(10.0, 5e-4, 0.0).has_value());
  EXPECT_FALSE(Ratio(10.0, 2e-4, 0.0).has_value());
  EXPECT_FALSE(Ratio(0.0, 0.1, 0.0).has_value());
}

TEST(SteeringRateRms, IsThatOfARampAndARest) {
  // The steering rate is 0.1 rad/s for a quarter of the time and then 0, so its RMS is 0.1
  // sqrt(1/4) rad/s.
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i <= 400; ++i) {
    LogRow row;
    row.state.time = 0.02 * i;
    row.state.steering = 0.002 * std::min(i, 100);
    log.rows.push_back(row);
  }
  VehicleParams vehicle;
  vehicle.wheelbase = 2.5;
  const PlantMetrics metrics = Measure(log, Plan{}, vehicle, 0.02, StationSource::kProjection);
  EXPECT_NEAR(metrics.steering_rate_rms, 0.05, Tolerance(1e-12));
  EXPECT_NEAR(ToJson(metrics)["steering_rate_rms"].get<double>(), 0.05, Tolerance(1e-12));
}

/// Saturated fraction of 400 control periods of a car that turns its wheels by up to `step` [rad]
/// in each.
double Saturated(double step, double limit, const std::function<double(int)>& command) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  double angle = 0.0;
  for (int i = 0; i <= 400; ++i) {
    LogRow row;
    row.state.time = 0.02 * i;
    row.state.steering_actuator = angle;
    row.command.steering = command(i);
    log.rows.push_back(row);
    angle += std::clamp(std::clamp(row.command.steering, -limit, limit) - angle, -step, step);
  }
  VehicleParams vehicle;
  vehicle.wheelbase = 2.5;
  vehicle.steering_rate = 0.4;
  vehicle.steering_limit = 0.5;
  return Measure(log, Plan{}, vehicle, 0.02, StationSource::kProjection)
      .steering_saturated_fraction;
}

TEST(SaturatedFraction, CountsTheRateLimit) {
  // Turning by 0.08 rad at 0.008 rad per period takes ten periods.
  EXPECT_EQ(Saturated(0.008, 0.5, [](int i) { return i >= 100 ? 0.08 : 0.0; }), 10.0 / 400.0);
}

TEST(SaturatedFraction, CountsCommandsThatTheActuatorJustReaches) {
  // The command rises by 0.008 rad per period for 30 periods, as fast as the actuator turns. The
  // actuator reaches each command within its period.
  EXPECT_EQ(Saturated(0.008, 0.5, [](int i) { return 0.008 * std::clamp(i - 100, 0, 30); }),
            30.0 / 400.0);
  // At 99 % of the rate, no period is saturated.
  EXPECT_EQ(Saturated(0.008, 0.5, [](int i) { return 0.00792 * std::clamp(i - 100, 0, 30); }), 0.0);
}

TEST(SaturatedFraction, CountsCommandsOfTheLargestAngle) {
  // The command rises by 0.002 rad per period, a quarter of the rate, to the largest angle of 0.5
  // rad. Periods 250 to 399 end at this angle; period 249 ends at 0.498 rad.
  EXPECT_EQ(Saturated(0.008, 0.5, [](int i) { return std::min(0.002 * i, 0.5); }), 150.0 / 400.0);
}

TEST(SaturatedFraction, DoesNotCountWhatTheActuatorWasNotAsked) {
  // Wheels that turn more slowly than the rate limit, as behind a delay or a lag, are not
  // saturated.
  EXPECT_EQ(Saturated(0.004, 0.5, [](int i) { return 0.001 * i; }), 0.0);
  EXPECT_EQ(Saturated(0.004, 0.5, [](int i) { return i >= 100 ? 0.08 : 0.0; }), 0.0);
}

/// Metrics of a run that drove 20 m in 8 s.
PlantMetrics Measured(const std::string& plant) {
  PlantMetrics metrics;
  metrics.plant = plant;
  metrics.end_s = 20.0;
  metrics.time = 8.0;
  metrics.lateral_acceleration_max = 3.0;
  metrics.lateral_acceleration_max_s = 12.0;
  metrics.lateral_acceleration_max_t = 4.0;
  metrics.steering_rate_rms = 0.25;
  metrics.tracking = TrackingMetrics{.cross_track_max = 0.5,
                                     .cross_track_max_s = 6.0,
                                     .cross_track_max_t = 2.0,
                                     .cross_track_final = -0.125,
                                     .goal_distance = 0.75};
  metrics.clearance = ClearanceMetrics{.min = 0.25,
                                       .min_s = 7.0,
                                       .min_t = 2.5,
                                       .force_max = 9.0,
                                       .force_max_s = 7.5,
                                       .force_max_t = 2.75};
  metrics.turns = {{.measured = {.lateral_offset = 0.75}, .s = 11.0, .t = 4.5}};
  metrics.maneuver = ManeuverMetrics{
      .method = "braking", .begin = 1.0, .end = 3.0, .values = {{"distance", 40.0}}};
  return metrics;
}

/// The only failure of a run with this expectation.
std::string DescribeFailure(const MetricExpectation& expect) {
  Expectations all;
  all.all.metrics = {expect};
  const Verdict verdict = Judge(all, {Measured("mujoco")}, {});
  EXPECT_EQ(verdict.failures.size(), 1U);
  EXPECT_FALSE(verdict.passed);
  return verdict.failures.empty() ? "" : verdict.failures.front();
}

TEST(Judge, SaysOfAnyMetricWhatWasWhereAndWhen) {
  EXPECT_EQ(DescribeFailure({.metric = "lateral_acceleration_max", .max = 2.0}),
            "mujoco: lateral_acceleration_max 3 m/s^2 exceeds 2 m/s^2 at s = 12 m, t = 4 s");
  EXPECT_EQ(DescribeFailure({.metric = "cross_track.max", .max = 0.1}),
            "mujoco: cross_track.max 0.5 m exceeds 0.1 m at s = 6 m, t = 2 s");
  EXPECT_EQ(DescribeFailure({.metric = "clearance_min", .min = 1.0}),
            "mujoco: clearance_min 0.25 m is below 1 m at s = 7 m, t = 2.5 s");
  EXPECT_EQ(DescribeFailure({.metric = "maneuver.distance", .max = 30.0}),
            "mujoco: maneuver.distance 40 m exceeds 30 m between t = 1 s and 3 s");
  const std::string end = " at the end, s = 20 m, t = 8 s";
  EXPECT_EQ(DescribeFailure({.metric = "time", .max = 5.0}), "mujoco: time 8 s exceeds 5 s" + end);
  EXPECT_EQ(DescribeFailure({.metric = "goal_distance", .max = 0.5}),
            "mujoco: goal_distance 0.75 m exceeds 0.5 m" + end);
  EXPECT_EQ(DescribeFailure({.metric = "cross_track.final", .min = 0.0}),
            "mujoco: cross_track.final -0.125 m is below 0 m" + end);
  EXPECT_EQ(DescribeFailure({.metric = "status", .equals = "collided"}),
            "mujoco: status is arrived instead of collided" + end);
  EXPECT_EQ(
      DescribeFailure({.metric = "steering_rate_rms", .max = 0.1}),
      "mujoco: steering_rate_rms 0.25 rad/s exceeds 0.1 rad/s over the run to s = 20 m, t = 8 s");
  EXPECT_EQ(DescribeFailure({.metric = "plan_changes", .equals = "2"}),
            "mujoco: plan_changes is 0 instead of 2 over the run to s = 20 m, t = 8 s");
  EXPECT_EQ(DescribeFailure({.metric = "obstacle_force_max", .max = 5.0}),
            "mujoco: obstacle_force_max 9 N exceeds 5 N at s = 7.5 m, t = 2.75 s");
  EXPECT_EQ(DescribeFailure({.metric = "collision", .equals = "true"}),
            "mujoco: collision is false instead of true at s = 7 m, t = 2.5 s");
  EXPECT_EQ(DescribeFailure({.metric = "turns[0].lateral_offset", .max = 0.5}),
            "mujoco: turns[0].lateral_offset 0.75 m exceeds 0.5 m at s = 11 m, t = 4.5 s");
  EXPECT_EQ(DescribeFailure({.metric = "cross_track.max_s", .max = 5.0}),
            "mujoco: cross_track.max_s 6 m exceeds 5 m over the run to s = 20 m, t = 8 s");
}

TEST(Judge, DistinguishesWhatFourDigitsDoNot) {
  EXPECT_EQ(DescribeFailure({.metric = "steering_rate_rms", .max = 0.2499999}),
            "mujoco: steering_rate_rms 0.25 rad/s exceeds 0.2499999 rad/s over the run to s = 20 "
            "m, t = 8 s");
  Expectations expect;
  expect.all = {.rms_cross_track = 0.0370301};
  PlantMetrics metrics = Measured("mujoco");
  metrics.tracking->cross_track_rms = 0.0370302;
  EXPECT_EQ(Judge(expect, {metrics}, {}).failures,
            std::vector<std::string>{"mujoco: rms cross-track error 0.0370302 m exceeds 0.0370301 "
                                     "m over the run to s = 20 m, t = 8 s"});
}

TEST(Judge, SaysWhyAMetricIsNotThere) {
  EXPECT_EQ(DescribeFailure({.metric = "turns[7].lateral_offset", .max = 0.5}),
            "mujoco: turns[7].lateral_offset is not available: the run has 1 isolated turn");
  EXPECT_EQ(DescribeFailure({.metric = "steering_rat_max", .max = 0.5}),
            "mujoco: no metric 'steering_rat_max'; did you mean 'steering_rate_max'?");
  Expectations expect;
  expect.all.metrics = {{.metric = "maneuver.margin", .min = 0.0},
                        {.metric = "recovery_time", .max = 1.0}};
  PlantMetrics metrics = Measured("mujoco");
  metrics.maneuver->missing = "the car never came there";
  metrics.recovery = RecoveryMetrics{.from = 3.0, .time = {}};
  EXPECT_EQ(
      Judge(expect, {metrics}, {}).failures,
      (std::vector<std::string>{
          "mujoco: maneuver.margin was not measured: the car never came there",
          "mujoco: recovery_time is not defined: the car did not recover after t = 3 s; end of "
          "the run at s = 20 m, t = 8 s"}));
  metrics.recovery->time = 2.0;
  expect.all.metrics = {{.metric = "recovery_time", .max = 1.0}};
  EXPECT_EQ(Judge(expect, {metrics}, {}).failures,
            std::vector<std::string>{"mujoco: recovery_time 2 s exceeds 1 s after t = 3 s"});
}

TEST(Judge, LetsAScenarioSayHowItEnds) {
  PlantMetrics metrics = Measured("mujoco");
  metrics.status = DriveStatus::kTimeLimit;
  EXPECT_EQ(
      Judge({}, {metrics}, {}).failures,
      std::vector<std::string>{"mujoco: did not reach the goal: time_limit at s = 20 m, t = 8 s"});
  Expectations expect;
  expect.plants = {{"mujoco", {.metrics = {{.metric = "status", .equals = "time_limit"}}}}};
  EXPECT_TRUE(Judge(expect, {metrics}, {}).passed);
  expect.plants[0].first = "kinematic";  // has no bound for this plant
  EXPECT_FALSE(Judge(expect, {metrics}, {}).passed);
}

TEST(Judge, HoldsPlantsAgainstEachOtherInEitherOrder) {
  const PlantComparison apart{.first = "kinematic",
                              .second = "mujoco",
                              .to_s = 20.0,
                              .position = {.rms = 0.1, .max = 0.5, .max_s = 12.0, .max_t = 4.0}};
  Expectations expect;
  expect.between = {{{"mujoco", "kinematic"}, {.position_max = 0.5}}};
  EXPECT_TRUE(Judge(expect, {}, {apart}).passed);
  expect.between[0].bounds.position_max = 0.25;
  EXPECT_EQ(
      Judge(expect, {}, {apart}).failures,
      std::vector<std::string>{
          "kinematic and mujoco: position difference 0.5 m exceeds 0.25 m at s = 12 m, t = 4 s"});
  EXPECT_EQ(Judge(expect, {}, {}).failures,
            std::vector<std::string>{
                "mujoco and kinematic: cannot be compared: not both plants were run"});
}

TEST(Measure, SaysWhereAndWhenTheLargestValuesWere) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i <= 400; ++i) {
    LogRow row;
    row.state.time = 0.02 * i;
    row.state.distance = 0.06 * i;
    // The lateral acceleration is -2 m/s^2 for 0.1 s, in the rows 150 to 155, and larger in a
    // single row.
    row.state.lateral_acceleration = i >= 150 && i < 156 ? -2.0 : i == 50 ? -6.0 : 1.0;
    row.state.steering = 0.002 * std::clamp(i - 200, 0, 5);  // 0.01 rad in the 0.1 s up to 4.1 s
    row.clearance = 1.0;
    row.state.obstacle_force = i == 50 ? 7.0 : 0.0;
    log.rows.push_back(row);
  }
  VehicleParams vehicle;
  vehicle.wheelbase = 2.5;
  const PlantMetrics metrics = Measure(log, Plan{}, vehicle, 0.02, StationSource::kProjection);
  EXPECT_EQ(metrics.lateral_acceleration_max, 2.0);
  EXPECT_DOUBLE_EQ(metrics.lateral_acceleration_max_s, 0.06 * 152);
  EXPECT_DOUBLE_EQ(metrics.lateral_acceleration_max_t, 0.02 * 152);
  EXPECT_NEAR(metrics.steering_rate_max, 0.1, Tolerance(1e-12));
  EXPECT_DOUBLE_EQ(metrics.steering_rate_max_s, 12.3);
  EXPECT_DOUBLE_EQ(metrics.steering_rate_max_t, 4.1);
  EXPECT_DOUBLE_EQ(metrics.end_s, 24.0);
  EXPECT_EQ(metrics.clearance->force_max, 7.0);
  EXPECT_DOUBLE_EQ(metrics.clearance->force_max_s, 3.0);
  EXPECT_DOUBLE_EQ(metrics.clearance->force_max_t, 1.0);
}

TEST(SideslipMax, IsTheLargestOfTheMovingCarBeforeAContact) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i <= 400; ++i) {
    LogRow row;
    row.state.time = 0.02 * i;
    row.state.distance = 0.06 * i;
    row.state.speed = i < 10 ? 0.5 : 3.0;
    // Sideslip is larger while the car creeps and after the contact at 7 s; neither counts.
    row.state.sideslip = i < 10 ? 0.5 : i == 200 ? -0.25 : i > 350 ? 0.75 : 0.125;
    log.rows.push_back(row);
  }
  log.contact_time = 7.0;
  VehicleParams vehicle;
  vehicle.wheelbase = 2.5;
  const nlohmann::ordered_json json =
      ToJson(Measure(log, Plan{}, vehicle, 0.02, StationSource::kProjection));
  EXPECT_EQ(json["sideslip_max"], 0.25);
  EXPECT_DOUBLE_EQ(json["sideslip_max_s"].get<double>(), 12.0);
  EXPECT_DOUBLE_EQ(json["sideslip_max_t"].get<double>(), 4.0);
}

TEST(Status, IsOfTheContactAndNotOfTheEnd) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i <= 400; ++i) {
    LogRow row;
    row.state.time = 0.02 * i;
    row.state.distance = 0.06 * i;
    row.state.speed = 3.0;
    row.state.lateral_acceleration = i > 350 ? 40.0 : 0.5;  // the impact at 7 s
    log.rows.push_back(row);
  }
  VehicleParams vehicle;
  vehicle.wheelbase = 2.5;
  const auto measured = [&] {
    return ToJson(Measure(log, Plan{}, vehicle, 0.02, StationSource::kProjection));
  };
  log.status = DriveStatus::kArrived;
  EXPECT_DOUBLE_EQ(measured()["status_t"].get<double>(), 8.0);
  EXPECT_DOUBLE_EQ(measured()["status_s"].get<double>(), 24.0);
  log.status = DriveStatus::kCollided;
  log.contact_time = 7.005;  // between two rows: the station is that of the later row
  EXPECT_DOUBLE_EQ(measured()["status_t"].get<double>(), 7.005);
  EXPECT_DOUBLE_EQ(measured()["status_s"].get<double>(), 0.06 * 351);
  EXPECT_DOUBLE_EQ(measured()["time"].get<double>(), 8.0);
  // The row of 7.00 s is the last before the contact.
  EXPECT_DOUBLE_EQ(measured()["lateral_acceleration_max"].get<double>(), 0.5);
}

}  // namespace metrics_test
}  // namespace trackbed
