#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests drives along plans with cusps: the car stops at each cusp, changes gear and continues.
namespace trackbed {
namespace {

/// The car turns by 180 degrees to a goal 6 m to its left by driving forward, backward and forward.
Scenario TurnRound(const std::string& plant, const std::string& rest = "") {
  return ParseScenario(
      fmt::format("schema: 1\nname: cusps\n"
                  "mission: {{speed: 3, waypoints: [[0, 0], [0, 6]], headings: [0, 3.1416],\n"
                  "          start: {{speed: 0}}}}\n"
                  "plan: {{method: reeds_shepp, curvature: steps}}\ncontrol: {{method: preview}}\n"
                  "drive: {{plants: [{}]}}\n{}",
                  plant, rest),
      "test.yaml", ".");
}

struct Driven {
  Plan plan;
  RunLog log;
};

Driven Drive(const Scenario& scenario) {
  const CarModel car = LoadCar(scenario);
  FeasiblePlan plan = PlanScenario(scenario, car.params());
  EXPECT_TRUE(plan.ok()) << plan->reason;
  RunLog log = SimulateScenario(scenario, car, plan, scenario.drive.plants.front());
  return {plan, std::move(log)};
}

class Cusps : public ::testing::TestWithParam<std::string> {};

TEST_P(Cusps, AreDrivenGearByGear) {
  const auto [plan, log] = Drive(TurnRound(GetParam()));
  const std::vector<Stations> legs = SplitIntoLegs(plan.reference.path);
  ASSERT_GE(legs.size(), 2U);
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  // The end pose deviates because of the steering ramps and because the controller cuts corners.
  const Pose2& end = log.rows.back().state.pose;
  EXPECT_LE((end.position() - plan.goal.position()).norm(), 0.5);
  EXPECT_LE(std::abs(AngleDifference(end.yaw, plan.goal.yaw)), 0.1);
  double largest = 0.0;
  double station = 0.0;
  for (const LogRow& row : log.rows) {
    largest = std::max(largest, std::abs(row.tracking->cross_track));
    // The car does not move against its gear, except when the tyres spring back after the brakes
    // release. Braking at a = 1.5 m/s^2 deflects the tyres by sigma a/(p_kx1 g). The deflection
    // oscillates with the angular frequency sqrt(p_kx1 g/sigma), so the car moves at up to a
    // sqrt(sigma/(p_kx1 g)) = 0.06 m/s for 0.1 s.
    EXPECT_GE(row.state.speed * row.command.gear, -0.06) << "at " << row.state.time;
    const bool moves = std::abs(row.state.speed) > 0.1;
    const PathPoint at = plan.reference.path.At(row.tracking->s);
    const bool near_a_cusp = std::any_of(legs.begin(), legs.end(), [&](const Stations& leg) {
      return std::abs(row.tracking->s - leg.to) < 0.6;
    });
    if (moves && !near_a_cusp) {
      EXPECT_EQ(row.command.gear, at.direction) << "at " << row.state.time;
    }
    EXPECT_GE(row.tracking->s, station - 0.6);
    station = std::max(station, row.tracking->s);
  }
  EXPECT_LE(largest, 0.5);
}

TEST_P(Cusps, AreStoodAtUntilTheWheelsHaveTurned) {
  const auto [plan, log] = Drive(TurnRound(GetParam()));
  int changes = 0;
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    if (log.rows[i].command.gear == log.rows[i - 1].command.gear) {
      continue;
    }
    ++changes;
    EXPECT_LE(std::abs(log.rows[i].state.speed), 0.02);
    const double limit = LoadCar(TurnRound(GetParam())).params().steering_limit;
    const double asked = std::clamp(log.rows[i].command.steering, -limit, limit);
    // The test counts wheels as at rest if they turn by less than 1e-4 rad in a period. The car
    // must have been at rest while the wheels turned.
    EXPECT_NEAR(log.rows[i].state.steering_actuator, asked, Tolerance(1e-3));
    std::size_t stood = 0;
    while (stood < i && std::abs(log.rows[i - stood].state.speed) <= 0.02) {
      ++stood;
    }
    EXPECT_GT(stood, 10U);
  }
  EXPECT_EQ(changes, static_cast<int>(SplitIntoLegs(plan.reference.path).size()) - 1);
}

INSTANTIATE_TEST_SUITE_P(Plants, Cusps, ::testing::Values("kinematic", "mujoco"),
                         [](const auto& test) { return test.param; });

TEST(Backwards, IsDrivenFromTheStartOn) {
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: back\n"
      "mission: {speed: 2, waypoints: [[0, 0], [-20, 3]], headings: [0, 0], start: {speed: 0}}\n"
      "plan: {method: reeds_shepp}\ncontrol: {method: preview}\ndrive: {plants: [kinematic]}\n",
      "test.yaml", ".");
  const auto [plan, log] = Drive(scenario);
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  for (const LogRow& row : log.rows) {
    EXPECT_EQ(row.command.gear, -1);
    EXPECT_LE(row.state.speed, 0.0);
  }
  EXPECT_LE((log.rows.back().state.pose.position() - Vec2(-20.0, 3.0)).norm(), 0.3);
}

}  // namespace
}  // namespace trackbed
