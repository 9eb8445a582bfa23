#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/drive/drive.h"

// Tests maneuvers over time: the car follows the specified steering and speed.
namespace trackbed {
namespace maneuver_test {

RunLog Drive(const std::string& control, const std::string& rest) {
  const Scenario scenario = ParseScenario(
      fmt::format("schema: 1\nname: maneuver\ncontrol: {}\n{}\n", control, rest), "test.yaml", ".");
  const CarModel car = LoadCar(scenario);
  return SimulateScenario(scenario, car, PlanScenario(scenario, car.params()),
                          scenario.drive.plants.front());
}

const VehicleState& At(const RunLog& log, double time) {
  return log.rows.at(static_cast<std::size_t>(std::lround(time / 0.02))).state;
}

TEST(Maneuver, BrakesToStandstillAndStays) {
  const RunLog log =
      Drive("{method: sine, amplitude: 0, speed: {braking: {at: 2, deceleration: 8}}}",
            "mission: {speed: 20, duration: 6}\ndrive: {plants: [kinematic]}");
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  // Braking from 20 m/s at 8 m/s^2 takes 20/8 = 2.5 s and 400/16 = 25 m. The tolerances cover the
  // rounding of about a hundred additions of 0.16 m/s.
  EXPECT_EQ(At(log, 2.0).speed, 20.0);
  EXPECT_NEAR(At(log, 3.0).speed, 12.0, Tolerance(1e-12));
  EXPECT_NEAR(At(log, 4.6).speed, 0.0, Tolerance(1e-12));
  EXPECT_NEAR(log.rows.back().state.pose.x, 40.0 + 25.0, Tolerance(1e-11));
  EXPECT_EQ(log.rows.back().state.speed, 0.0);
}

TEST(Maneuver, BrakesInATurnOnMujocoToo) {
  const RunLog log = Drive(
      "{method: constant_steering, steering: 0.05, speed: {braking: {at: 1, deceleration: 4}}}",
      "mission: {speed: 10, duration: 3, start: {steering: 0.05}}\ndrive: {plants: [mujoco]}");
  // The brake commands account for the car's mass and its wheels' inertia. Cornering at up to 2
  // m/s^2 with slip angles of milliradians adds at most 0.01 m/s^2 of drag; the tolerance of 1 %
  // covers that.
  EXPECT_NEAR(At(log, 2.0).speed - At(log, 3.0).speed, 4.0, Tolerance(0.04));
  EXPECT_GT(At(log, 3.0).yaw_rate, 0.0);
}

TEST(Maneuver, FollowsTheSpeedOverTime) {
  const RunLog log =
      Drive("{method: sine, amplitude: 0, speed: {over_time: [[1, 20], [2, 12], [4, 16]]}}",
            "mission: {duration: 5}\ndrive: {plants: [kinematic]}");
  const Signal speed{{{1.0, 20.0}, {2.0, 12.0}, {4.0, 16.0}}};
  for (const LogRow& row : log.rows) {
    // The tolerance covers 250 additions to numbers below 32, rounded by up to half an ulp,
    // 1.8e-15, each.
    EXPECT_NEAR(row.state.speed, speed.At(row.state.time), Tolerance(250 * 1.8e-15));
  }
}

TEST(Maneuver, StepsAtTheActuatorsRate) {
  const RunLog log = Drive("{method: step, amplitude: 0.1, at: 1}",
                           "mission: {speed: 3, duration: 3}\ndrive: {plants: [kinematic]}");
  const double rate = 0.15056818181818182;
  EXPECT_EQ(At(log, 1.0).steering, 0.0);
  EXPECT_NEAR(At(log, 1.4).steering, 0.4 * rate, Tolerance(1e-14));
  EXPECT_EQ(At(log, 2.0).steering, 0.1);
}

TEST(Maneuver, StepsInOnePeriodWhenPrescribed) {
  const RunLog log =
      Drive("{method: step, amplitude: 0.1, at: 1}",
            "mission: {speed: 3, duration: 3}\ndrive: {plants: [kinematic], steering: prescribed}");
  EXPECT_EQ(At(log, 1.0).steering, 0.0);
  EXPECT_EQ(At(log, 1.02).steering, 0.1);
}

}  // namespace maneuver_test
}  // namespace trackbed
