// Tests the checker on a run without faults, then on the same run with one fault at a time.

#include "tests/audit/checker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

namespace audit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using trackbed::Table;

constexpr double kSpeed = 5.0;       // [m/s]
constexpr double kLength = 40.0;     // length of the plan, along x [m]
constexpr double kBrake = 2.0;       // [m/s^2]
constexpr double kPeriod = 0.02;     // [s]
constexpr double kTimestep = 0.002;  // [s]

double PlannedSpeed(double s) {
  return std::min(kSpeed, std::sqrt(2.0 * kBrake * std::max(0.0, kLength - s)));
}

struct PlanCells {
  double s, x, y, yaw, curvature, speed;
};

/// plan.csv of a straight of 40 m along x at 5 m/s that ends at rest; `change` modifies each row.
Table StraightPlan(const std::function<void(PlanCells&)>& change = {}) {
  Table table({"s_m", "x_m", "y_m", "yaw_rad", "curvature_radpm", "speed_mps", "direction"});
  for (int i = 0; i <= 400; ++i) {
    const double s = 0.1 * i;
    PlanCells row{s, s, 0.0, 0.0, 0.0, PlannedSpeed(s)};
    if (change) {
      change(row);
    }
    table.AddRow({row.s, row.x, row.y, row.yaw, row.curvature, row.speed, 1.0});
  }
  return table;
}

struct Motion {
  double t, x, y, yaw, speed, steering, command = 0.0;
};

/// Adds a run of a car that moves along the plan: constant 5 m/s, then braking, 9.25 s in all.
/// `change` modifies each motion.
Drive DriveAlong(const std::function<void(Motion&)>& change = {}) {
  constexpr double kUntilBraking = (kLength - 0.5 * kSpeed * kSpeed / kBrake) / kSpeed;
  const double duration = kUntilBraking + kSpeed / kBrake;
  const auto at = [&](double t) {
    const double braking = std::clamp(t - kUntilBraking, 0.0, kSpeed / kBrake);
    Motion motion{
        t,
        kSpeed * std::min(t, kUntilBraking) + kSpeed * braking - 0.5 * kBrake * braking * braking,
        0.0,
        0.0,
        kSpeed - kBrake * braking,
        0.0};
    if (change) {
      change(motion);
    }
    return motion;
  };
  Drive drive{.plant = "kinematic"};
  drive.log = Table({"t_s", "x_m", "y_m", "yaw_rad", "speed_mps", "steering_actuator_rad",
                     "steering_rad", "steering_command_rad", "a_column_more"});
  drive.steps = Table({"t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"});
  const auto steps = static_cast<int>(std::ceil(duration / kPeriod)) *
                     static_cast<int>(std::lround(kPeriod / kTimestep));
  for (int i = 0; i <= steps; ++i) {
    const Motion m = at(i * kTimestep);
    drive.steps.AddRow(
        {m.t, m.x, m.y, 0.0, std::cos(0.5 * m.yaw), 0.0, 0.0, std::sin(0.5 * m.yaw)});
    if (i % 10 == 0) {
      drive.log.AddRow({m.t, m.x, m.y, m.yaw, m.speed, m.steering, m.steering, m.command, 7.0});
    }
  }
  drive.metrics = {{"status", "arrived"},
                   {"time", drive.log.Column("t_s").back()},
                   {"cross_track", {{"max", 0.0}}},
                   {"goal_distance", 0.0},
                   {"steering_rate_max", 0.0}};
  return drive;
}

/// A car of the size of a Prius, on a road of friction 0.9.
Record GoodRun() {
  Record record{.name = "straight", .plan_ok = true};
  record.plan = StraightPlan();
  record.passed = true;
  record.drives = {DriveAlong()};
  record.car = {.length = 4.48,
                .width = 1.76,
                .rear_overhang = 0.8,
                .wheelbase = 2.7,
                .steering_limit = 0.48,
                .steering_rate = 0.15,
                .friction = 0.9,
                .brake_deceleration = 10.0};
  record.mission = {.start = {},
                    .start_speed = kSpeed,
                    .goal = Point{kLength, 0.0},
                    .goal_heading = 0.0,
                    .acceleration = 1.0,
                    .time_limit = 40.0,
                    .timestep = kTimestep,
                    .control_period = kPeriod};
  return record;
}

/// Adds an obstacle and the clearance that metrics.json reports for it.
void AddObstacle(Record& record, const Box& box, double told) {
  record.mission.obstacles.push_back(box);
  record.drives[0].metrics["collision"] = told == 0.0;
  record.drives[0].metrics["clearance_min"] = told;
}

std::set<std::string> KindsIn(const Record& record) {
  std::set<std::string> kinds;
  for (const Finding& finding : Check(record)) {
    kinds.insert(finding.kind);
  }
  return kinds;
}

TEST(Checker, FindsNothingInAGoodRun) {
  Record record = GoodRun();
  EXPECT_THAT(Check(record), IsEmpty());
  // The box's near side is 3 m from the car's center line.
  AddObstacle(record, {{0.0, 20.0, 4.0, 0.0}, 2.0, 2.0, {}}, 3.0 - 0.88);
  EXPECT_THAT(Check(record), IsEmpty());
}

TEST(Checker, FindsABoxThatCrossesBetweenTwoRows) {
  Record record = GoodRun();
  // A board of 5 cm at 200 m/s crosses the car's nose at 3.006 s, between the rows of 3 s and 3.02
  // s.
  AddObstacle(record, {{3.006, 18.0, 0.0, 0.0}, 0.05, 0.05, {0.0, 200.0}}, 1.1);
  EXPECT_THAT(KindsIn(record), ElementsAre("clearance", "contact"));
}

TEST(Checker, FindsAClearanceThatIsToldTooLarge) {
  Record record = GoodRun();
  AddObstacle(record, {{0.0, 20.0, 4.0, 0.0}, 2.0, 2.0, {}}, 3.0 - 0.88 + 0.01);
  EXPECT_THAT(KindsIn(record), ElementsAre("clearance"));
}

TEST(Checker, FindsACollisionThatPasses) {
  Record record = GoodRun();
  AddObstacle(record, {{0.0, 20.0, 0.0, 0.0}, 1.0, 1.0, {}}, 0.0);
  EXPECT_THAT(KindsIn(record), ElementsAre("contact"));
  record.passed = false;
  record.drives[0].metrics["status"] = "collided";
  EXPECT_THAT(Check(record), IsEmpty());
}

TEST(Checker, FindsACarBehindTheStartOfItsPath) {
  Record record = GoodRun();
  record.drives[0] = DriveAlong([](Motion& m) {
    // The car jumps back to 20 m behind the start around 2 s, and then forward again.
    m.x -= 30.0 * std::max(0.0, 1.0 - std::abs(m.t - 2.0));
  });
  record.drives[0].metrics["cross_track"]["max"] = 0.022;
  EXPECT_THAT(KindsIn(record), ElementsAre("corridor", "cross_track"));
}

TEST(Checker, FindsACarOutsideItsCorridorEvenBetweenTwoRows) {
  Record record = GoodRun();
  record.drives[0] = DriveAlong([](Motion& m) { m.y = std::abs(m.t - 3.01) < 0.005 ? 1.9 : 0.0; });
  EXPECT_THAT(KindsIn(record), ElementsAre("corridor"));
  record.mission.max_cross_track = 2.0;
  EXPECT_THAT(Check(record), IsEmpty());
}

TEST(Checker, FindsAMissedGoal) {
  Record record = GoodRun();
  record.mission.goal = Point{kLength + 2.0, 0.0};
  record.drives[0].metrics["goal_distance"] = 2.0;
  EXPECT_THAT(KindsIn(record), ElementsAre("goal_position", "plan_end"));
  record = GoodRun();
  record.mission.goal_heading = 0.3;
  EXPECT_THAT(KindsIn(record), ElementsAre("goal_heading", "plan_end"));
  record = GoodRun();
  record.mission.goal = Point{kLength, 0.1};
  EXPECT_THAT(KindsIn(record), ElementsAre("goal_metric"));
}

TEST(Checker, FindsWheelsThatTurnTooFastOrTooFar) {
  Record record = GoodRun();
  const auto turning = [](double rate) {
    return [rate](Motion& m) { m.steering = std::min(0.1, rate * std::max(0.0, m.t - 1.0)); };
  };
  record.drives[0] = DriveAlong(turning(1.3 * 0.15));
  record.drives[0].metrics["steering_rate_max"] = 1.0;
  EXPECT_THAT(KindsIn(record), ElementsAre("steering_rate"));
  record.drives[0] = DriveAlong(turning(0.15));
  record.drives[0].metrics["steering_rate_max"] = 0.149;
  EXPECT_THAT(KindsIn(record), ElementsAre("steering_metric"));
  record.drives[0] = DriveAlong([](Motion& m) { m.steering = 0.49; });
  EXPECT_THAT(KindsIn(record), ElementsAre("steering_angle"));
}

TEST(Checker, FindsTimesThatAreNotThoseOfTheRows) {
  Record record = GoodRun();
  record.drives[0].metrics["time"] = 5.0;
  EXPECT_THAT(KindsIn(record), ElementsAre("time"));
  record = GoodRun();
  record.passed = false;
  record.drives[0].metrics["status"] = "time_limit";
  EXPECT_THAT(KindsIn(record), ElementsAre("time"));
  record = GoodRun();
  record.mission.control_period = 0.04;
  EXPECT_THAT(KindsIn(record), ElementsAre("time"));
}

TEST(Checker, FindsRowsThatAreNoNumbers) {
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    Record record = GoodRun();
    record.drives[0] = DriveAlong([bad](Motion& m) { m.y = m.t > 9.0 ? bad : 0.0; });
    EXPECT_THAT(KindsIn(record), ElementsAre("numbers"));
    record.drives[0] = DriveAlong([bad](Motion& m) { m.steering = m.t > 9.0 ? bad : 0.0; });
    EXPECT_THAT(KindsIn(record), ElementsAre("numbers"));
  }
}

TEST(Checker, FindsAFailureWithoutAReason) {
  Record record = GoodRun();
  record.passed = false;
  EXPECT_THAT(KindsIn(record), ElementsAre("verdict"));
  // Each of these expectations is a reason to fail.
  record.mission.max_time = 5.0;
  EXPECT_THAT(Check(record), IsEmpty());
  record.mission.max_time.reset();
  record.drives[0] = DriveAlong([](Motion& m) { m.y = std::abs(m.t - 4.0) < 1.0 ? 2.0 : 0.0; });
  record.drives[0].metrics["cross_track"]["max"] = 2.0;
  EXPECT_THAT(Check(record), IsEmpty());
  // A command that swings at 2 Hz by 0.01 rad is a reason; one that swings by 0.1 mrad is none.
  record.drives = {DriveAlong([](Motion& m) { m.command = 0.01 * std::sin(4.0 * M_PI * m.t); })};
  EXPECT_THAT(Check(record), IsEmpty());
  record.drives = {DriveAlong([](Motion& m) { m.command = 1e-4 * std::sin(4.0 * M_PI * m.t); })};
  EXPECT_THAT(KindsIn(record), ElementsAre("verdict"));
}

TEST(Checker, FindsExpectationsThatAreNotMet) {
  Record record = GoodRun();
  AddObstacle(record, {{0.0, 20.0, 4.0, 0.0}, 2.0, 2.0, {}}, 3.0 - 0.88);
  record.mission.min_clearance = 2.0;
  record.mission.max_time = 9.3;
  EXPECT_THAT(Check(record), IsEmpty());
  record.mission.min_clearance = 2.2;
  EXPECT_THAT(KindsIn(record), ElementsAre("expected_clearance"));
  record.mission.min_clearance.reset();
  record.mission.max_time = 9.2;
  EXPECT_THAT(KindsIn(record), ElementsAre("expected_time"));
}

TEST(Checker, FindsAVerdictThatItsStatusContradicts) {
  Record record = GoodRun();
  record.drives[0].metrics["status"] = "diverged";
  EXPECT_THAT(KindsIn(record), ElementsAre("verdict"));
  record.drives[0].metrics["status"] = "stopped";
  EXPECT_THAT(KindsIn(record), ElementsAre("verdict"));
  record = GoodRun();
  record.plan_ok = false;
  EXPECT_THAT(KindsIn(record), ElementsAre("verdict"));
}

TEST(Checker, FindsAPlanThatBrakesHarderThanTheCar) {
  Record record = GoodRun();
  record.plan = StraightPlan([](PlanCells& row) {
    row.speed = std::min(kSpeed, std::sqrt(2.0 * 14.0 * (kLength - row.s)));
  });
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_braking"));
  // On ice the tyres limit braking.
  record = GoodRun();
  record.mission.road_friction = 0.2;
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_braking"));
}

TEST(Checker, FindsAPlanThatAPatchDoesNotHold) {
  // The plan brakes at 2 m/s^2 over its last 6.25 m, but the patch allows only 0.9 * 0.2 * 9.81 =
  // 1.77 m/s^2.
  Record record = GoodRun();
  record.mission.patches = {{{{0.0, 37.0, 0.0, 0.5}, 4.0, 3.0, {}}, 0.2}};
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_braking"));
  record.mission.patches[0].area.center.y = 3.0;  // beside the car
  EXPECT_THAT(Check(record), IsEmpty());
}

TEST(Checker, FindsAPlanThatAGradeDoesNotHold) {
  Record record = GoodRun();
  record.mission.road_friction = 0.3;  // 0.9 * 0.3 * 9.81 = 2.65 m/s^2
  EXPECT_THAT(Check(record), IsEmpty());
  record.mission.grade = {-0.1, 0.0};  // downhill, by 0.98 m/s^2
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_braking"));
  record.mission.grade = {0.1, 0.0};
  EXPECT_THAT(Check(record), IsEmpty());
  record.mission.grade = {0.0, 0.3};  // across, by 2.82 m/s^2
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_hold"));
}

TEST(Checker, FindsAPlanThatSpeedsUpTooMuch) {
  Record record = GoodRun();
  record.plan = StraightPlan(
      [](PlanCells& row) { row.speed = std::min(row.speed, std::sqrt(4.0 + 2.0 * 1.2 * row.s)); });
  record.mission.start_speed = 2.0;
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_acceleration"));
}

/// A plan of 40 m at constant speed with curvature `curvature(s)`; poses by the midpoint rule.
Table BentPlan(double speed, const std::function<double(double)>& curvature) {
  Table table({"s_m", "x_m", "y_m", "yaw_rad", "curvature_radpm", "speed_mps", "direction"});
  double x = 0.0, y = 0.0, yaw = 0.0;
  constexpr int kFine = 100;
  for (int i = 0; i <= 400 * kFine; ++i) {
    const double s = 0.1 * i / kFine;
    if (i % kFine == 0) {
      table.AddRow({s, x, y, yaw, curvature(s), speed, 1.0});
    }
    const double ds = 0.1 / kFine;
    const double middle = yaw + 0.5 * ds * curvature(s);
    yaw += ds * curvature(s + 0.5 * ds);
    x += ds * std::cos(middle);
    y += ds * std::sin(middle);
  }
  return table;
}

std::set<std::string> KindsOfPlan(Record record, const Table& plan) {
  std::set<std::string> kinds;
  for (const Finding& finding : CheckPlan(plan, record, &record.drives[0], false, {})) {
    kinds.insert(finding.kind);
  }
  return kinds;
}

TEST(Checker, FindsAPlanThatTurnsHarderThanTyresHold) {
  const Record record = GoodRun();
  // At a curvature of 0.1 1/m, a speed of 9 m/s needs 8.1 m/s^2 and a speed of 10 m/s needs 10
  // m/s^2. The tyres provide 8.83 m/s^2.
  const auto arc = [](double) { return 0.1; };
  EXPECT_THAT(KindsOfPlan(record, BentPlan(9.0, arc)), IsEmpty());
  EXPECT_THAT(KindsOfPlan(record, BentPlan(10.0, arc)), ElementsAre("plan_lateral"));
  EXPECT_THAT(KindsOfPlan(record, BentPlan(1.0, [](double) { return 0.1935; })),
              ElementsAre("plan_steering_angle"));
}

TEST(Checker, FindsAPlanThatTurnsTheWheelsTooFast) {
  const Record record = GoodRun();
  // The steering angle atan(L kappa) is nearly L kappa. At 2 m/s, a steering rate of 0.15 rad/s
  // therefore corresponds to a curvature rate of 0.0278 1/m^2.
  const auto ramp = [](double share) {
    return [share](double s) { return std::min(0.1, share * 0.15 / 2.0 / 2.7 * s); };
  };
  EXPECT_THAT(KindsOfPlan(record, BentPlan(2.0, ramp(1.0))), IsEmpty());
  EXPECT_THAT(KindsOfPlan(record, BentPlan(2.0, ramp(1.3))), ElementsAre("plan_steering_rate"));
  // A curvature step is not judged as a ramp.
  EXPECT_THAT(KindsOfPlan(record, BentPlan(2.0, [](double s) { return s < 9.95 ? 0.0 : 0.1; })),
              IsEmpty());
}

TEST(Checker, FindsAKinkInAPlan) {
  Record record = GoodRun();
  record.plan = StraightPlan([](PlanCells& row) { row.yaw = row.s > 10.0 ? 0.05 : 0.0; });
  record.mission.goal_heading.reset();
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_geometry"));
}

TEST(Checker, FindsAPlanThatDoesNotBeginWhereTheCarIs) {
  Record record = GoodRun();
  record.mission.start.yaw = 0.01;
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_start_heading"));
  record = GoodRun();
  record.mission.start.y = 0.01;
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_start_position"));
  record = GoodRun();
  record.mission.start_speed = 4.0;
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_start_speed"));
  record = GoodRun();
  record.mission.start_steering = 0.01;
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_start_steering"));
}

TEST(Checker, FindsAPlanThatLeadsThroughWhatItKnows) {
  Record record = GoodRun();
  AddObstacle(record, {{0.0, 20.0, 0.0, 0.0}, 1.0, 1.0, {}}, 0.0);
  record.mission.planned_around = {0};
  record.passed = false;
  EXPECT_THAT(KindsIn(record), ElementsAre("plan_contact"));
}

/// There are two replans, the second 1 m beside the first. The car follows the line of the first
/// replan.
TEST(Checker, MeasuresFromThePlanThatIsDriven) {
  Record record = GoodRun();
  Table changes(
      {"from_t_s", "s_m", "x_m", "y_m", "yaw_rad", "curvature_radpm", "speed_mps", "direction"});
  for (const double from : {1.0, 2.0}) {
    for (int i = 0; i <= 350; ++i) {
      const double s = 0.1 * i;
      changes.AddRow({from, s, 5.0 + s, from - 1.0, 0.0, 0.0, PlannedSpeed(5.0 + s), 1.0});
    }
  }
  record.drives[0].changes = changes;
  EXPECT_THAT(KindsIn(record), ElementsAre("cross_track"));
  record.drives[0].metrics["cross_track"]["max"] = 1.0;
  EXPECT_THAT(Check(record), IsEmpty());
}

}  // namespace
}  // namespace audit
