#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "tests/support/case_names.h"
#include "tests/tolerance.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests starts, stops and speeds on slopes.
namespace trackbed {
namespace {

struct Outcome {
  DriveStatus status = DriveStatus::kArrived;
  double rolled_back = 0.0;    ///< largest [m]
  double speed_error = 0.0;    ///< RMS where the planned speed is constant [m/s]
  double goal_distance = 0.0;  ///< at the end [m]
};

/// Drives 20 m straight forward or backward, from rest to rest at up to 2 m/s.
Outcome Drive(const std::string& car_name, const std::string& plant, double grade, int direction,
              const std::string& infeasible = "slow_down") {
  const Scenario scenario = ParseScenario(
      fmt::format("schema: 1\nname: slope\nvehicle: {{model: {}}}\n"
                  "mission: {{speed: 2, waypoints: [[0, 0], [{}, 0]], headings: [0, 0], "
                  "start: {{speed: 0}}}}\n"
                  "world: {{ground: {{grade: {{x: {}}}}}}}\n"
                  "plan: {{method: reeds_shepp, infeasible: {}}}\n"
                  "drive: {{plants: ['{}'], time_limit: 40}}\n",
                  car_name, 20 * direction, grade, infeasible, plant),
      "slope.yaml", ".");
  const CarModel car = LoadCar(scenario);
  const FeasiblePlan plan = PlanScenario(scenario, car.unladen());
  const RunLog log = SimulateScenario(scenario, car, plan, plant);
  Outcome outcome{.status = log.status};
  double squares = 0.0;
  double count = 0.0;
  for (const LogRow& row : log.rows) {
    outcome.rolled_back = std::max(outcome.rolled_back, -direction * row.state.pose.x);
    const double along = direction * row.state.pose.x;
    if (along > 6.0 && along < 14.0) {
      squares += std::pow(direction * row.state.speed - 2.0, 2);
      count += 1.0;
    }
  }
  outcome.speed_error = std::sqrt(squares / std::max(count, 1.0));
  outcome.goal_distance = std::abs(log.rows.back().state.pose.x - 20.0 * direction);
  return outcome;
}

class Slopes : public testing::TestWithParam<std::tuple<const char*, const char*, double, int>> {};

INSTANTIATE_TEST_SUITE_P(Drives, Slopes,
                         testing::Combine(testing::Values("prius", "bmw320i"),
                                          testing::Values("mujoco:contact", "mujoco:magic_formula"),
                                          testing::Values(-0.2, -0.06, 0.06, 0.13, 0.2),
                                          testing::Values(1, -1)),
                         kNamedByParameter);

TEST_P(Slopes, AreStartedDrivenAndStoppedOn) {
  const auto& [car, plant, grade, direction] = GetParam();
  const Outcome outcome = Drive(car, plant, grade, direction);
  EXPECT_EQ(outcome.status, DriveStatus::kArrived);
  // The tyres reach their full drive force about ten timesteps of 2 ms after the brakes are
  // released. Meanwhile the car rolls back by g sin(0.2) (20 ms)^2/2 = 0.4 mm. The deflection of
  // the tyres, sigma mu with the relaxation length sigma, adds less than 0.05 m.
  EXPECT_LE(outcome.rolled_back, Tolerance(0.05));
  // The feed-forward compensates the slope, but not tyre drag and pitching. With the gain of 2 1/s,
  // a disturbance of 0.02 m/s^2 causes a speed error of 0.01 m/s.
  EXPECT_LE(outcome.speed_error, Tolerance(0.02));
  EXPECT_LE(outcome.goal_distance, Tolerance(0.1));
}

TEST(Slopes, HoldACarWhoseMotorIsTooWeak) {
  // A grade of 50 % requires 0.447 g = 4.4 m/s^2, but the motor of the Prius provides only 4.0
  // m/s^2. The brakes hold the car. Without `infeasible: allow`, there is no plan.
  const Outcome outcome = Drive("prius", "mujoco:magic_formula", 0.5, 1, "allow");
  EXPECT_EQ(outcome.status, DriveStatus::kStuck);
  EXPECT_LE(outcome.rolled_back, Tolerance(0.05));
}

TEST(Braking, OfNothingCoasts) {
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: coast\nmission: {speed: 20, duration: 3}\n"
      "control: {method: constant_steering, steering: 0, speed: {braking: {at: 1, deceleration: "
      "0}}}\ndrive: {plants: [mujoco]}\n",
      "coast.yaml", ".");
  const CarModel car = LoadCar(scenario);
  const RunLog log =
      SimulateScenario(scenario, car, PlanScenario(scenario, car.unladen()), "mujoco");
  double before = 0.0;
  for (const LogRow& row : log.rows) {
    if (row.state.time <= 1.0) {
      EXPECT_FALSE(row.command.coast && row.state.time < 1.0);
      EXPECT_NEAR(row.state.speed, 20.0, Tolerance(0.05));
    } else {
      EXPECT_TRUE(row.command.coast);
      EXPECT_LT(row.state.speed, before);
    }
    before = row.state.speed;
  }
}

}  // namespace
}  // namespace trackbed
