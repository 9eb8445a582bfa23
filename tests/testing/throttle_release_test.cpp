// Tests the double lane changes of ISO 3888 with released throttle.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/testing/scenario_testing.h"

namespace trackbed {
namespace {

constexpr double kSpeed = 12.0;   // [m/s]
constexpr double kPeriod = 0.01;  // [s]
constexpr double kLeadIn = 30.0;  // default of plan.lead_in [m]
constexpr double kCourse = 61.0;  // length of the course of ISO 3888-2 [m]

RunResult RunCourse(const std::string& plant, const std::vector<Override>& overrides) {
  return RunScenario(
      ParseScenario("schema: 1\nname: course\nvehicle: {model: bmw320i, tyre: magic_formula}\n"
                    "mission: {speed: 12}\n"
                    "plan: {method: lane_change, standard: iso_3888_2, leave: 1, join: 3, "
                    "infeasible: allow}\ncontrol: {method: preview, distance: 7}\n"
                    "maneuver: {method: lane_change}\n"
                    "drive: {plants: [" +
                        plant + "], control_period: 0.01}\n",
                    "course", ".", overrides));
}

/// Returns the distance of the car's rear end from the end of the last gate at the end of the run
/// [m]. The last gate is parallel to the x axis, on which the car starts at 0.
double Beyond(const RunResult& run) {
  const LogRow& last = run.logs[0].rows.back();
  EXPECT_NEAR(last.state.pose.yaw, 0.0, Tolerance(0.05));
  return last.state.pose.x - run.vehicle.rear_overhang - kLeadIn - kCourse;
}

const LogRow& FirstCoasting(const RunResult& run) {
  const std::vector<LogRow>& rows = run.logs[0].rows;
  return *std::find_if(rows.begin(), rows.end(),
                       [](const LogRow& row) { return row.command.coast; });
}

TEST(ThrottleRelease, CoastsFromItsPlaceToTheEndOfTheCourse) {
  for (const char* plant : {"kinematic", "mujoco"}) {
    const RunResult run = RunCourse(plant, {"plan.release=2"});
    EXPECT_THAT(run, MeetsItsExpectations());
    EXPECT_EQ(run.metrics[0].status, DriveStatus::kArrived);
    EXPECT_EQ(run.metrics[0].maneuver->missing, "");
    // The front of the car is 2 m behind the start of section 1, at most one period later.
    const double front =
        FirstCoasting(run).state.pose.x + run.vehicle.length - run.vehicle.rear_overhang;
    EXPECT_GE(front, kLeadIn + 2.0 - Tolerance(1e-9));
    EXPECT_LT(front, kLeadIn + 2.0 + kSpeed * kPeriod + Tolerance(1e-3));
    // The corners of a car that is turned by up to 0.05 rad are up to 0.05 m apart along x.
    EXPECT_GE(Beyond(run), -Tolerance(0.05));
    EXPECT_LT(Beyond(run), kSpeed * kPeriod + Tolerance(0.05));
  }
}

TEST(ThrottleRelease, LosesNoSpeedWithoutDrag) {
  const RunResult run = RunCourse("kinematic", {"plan.release=2"});
  EXPECT_EQ(run.logs[0].rows.back().state.speed, FirstCoasting(run).state.speed);
  const RunResult real = RunCourse("mujoco", {"plan.release=2"});
  EXPECT_LT(real.logs[0].rows.back().state.speed, FirstCoasting(real).state.speed - 0.1);
}

TEST(ThrottleRelease, MayAlsoHaveATime) {
  // At 12 m/s, the car reaches the course of 30 m to 91 m between 2.5 s and 7.6 s.
  const RunResult run = RunCourse("kinematic", {"control.speed.braking={at: 2, deceleration: 0}"});
  EXPECT_EQ(run.metrics[0].status, DriveStatus::kArrived);
  EXPECT_LT(Beyond(run), kSpeed * kPeriod + Tolerance(0.05));
}

TEST(ThrottleRelease, GivesWayToBraking) {
  const RunResult run =
      RunCourse("kinematic", {"plan.release=2", "control.speed.braking={at: 4, deceleration: 6}"});
  EXPECT_NE(run.metrics[0].status, DriveStatus::kTimeLimit);
  // From 4 s on, the car brakes from 12 m/s at 6 m/s^2 for 2 s. It then rests for 1 s.
  EXPECT_LT(run.metrics[0].time, 7.0);
  EXPECT_FALSE(run.metrics[0].maneuver->passed.value_or(false));
}

TEST(ThrottleRelease, IsOffByDefault) {
  const RunResult run = RunCourse("kinematic", {});
  EXPECT_EQ(run.metrics[0].status, DriveStatus::kArrived);
  EXPECT_LT(run.metrics[0].tracking->goal_distance, Tolerance(0.5));
  EXPECT_THAT(run.logs[0].rows, testing::Each(testing::Field(
                                    &LogRow::command, testing::Field(&Command::coast, false))));
}

}  // namespace
}  // namespace trackbed
