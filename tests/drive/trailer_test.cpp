#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/case_names.h"
#include "tests/support/simulate_planned.h"
#include "tests/tolerance.h"
#include "trackbed/drive/drive.h"
#include "trackbed/drive/start_overlap.h"
#include "trackbed/planning/common/plan.h"

// Tests runs with a trailer: log, jackknife, clearance and start.
namespace trackbed {
namespace drive_trailer_test {

Scenario Towing(const std::string& plan, const std::string& trailer, const std::string& more = "") {
  return ParseScenario(
      fmt::format("schema: 1\nname: towing\n"
                  "vehicle: {{model: prius{}}}\n"
                  "mission: {{speed: 2, waypoints: [[0, 0], [{}, 0]], start: {{speed: 0}}}}\n"
                  "plan: {{method: {}}}\n{}",
                  trailer.empty() ? "" : ", trailer: " + trailer, plan == "reeds_shepp" ? -30 : 30,
                  plan == "reeds_shepp" ? "reeds_shepp" : plan, more),
      "towing.yaml", ".");
}

class TrailerRun : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Plants, TrailerRun,
                         testing::Values("kinematic", "mujoco:contact", "mujoco:magic_formula"),
                         kNamedByParameter);

TEST_P(TrailerRun, LogsTheHitch) {
  const Table table = ToTable(SimulatePlanned(Towing("fillet", "{}"), GetParam()));
  const std::vector<double> angle = table.Column("hitch_angle_rad");
  // Straight ahead, only rounding errors and the residuals of MuJoCo's solver turn the trailer.
  EXPECT_LT(*std::max_element(angle.begin(), angle.end()), 1e-3);
  EXPECT_THAT(table.columns(), testing::Contains("hitch_rate_radps"));
  const Table without = ToTable(SimulatePlanned(Towing("fillet", ""), GetParam()));
  EXPECT_THAT(without.columns(), testing::Not(testing::Contains("hitch_angle_rad")));
}

// Scenarios refuse planners that reverse, so the plan is made for the car alone. The wheels of the
// plan turn at the start, which turns the trailer, whose angle then grows.
TEST_P(TrailerRun, JackknifesInReverse) {
  Scenario alone = Towing("reeds_shepp", "", "");
  alone.mission.headings = {0.0, 0.3};
  Scenario scenario = Towing("fillet", "{}");
  scenario.mission.waypoints = alone.mission.waypoints;
  const CarModel bare = LoadCar(alone);
  const FeasiblePlan plan = PlanScenario(alone, bare.unladen());
  ASSERT_TRUE(plan.ok()) << plan->reason;
  const CarModel car = LoadCar(scenario);
  const RunLog log = SimulateScenario(scenario, car, plan, GetParam());
  EXPECT_EQ(log.status, DriveStatus::kJackknifed) << ToString(log.status) << log.cause;
  EXPECT_THAT(log.cause, testing::HasSubstr("the trailer touches the car"));
  const double limit = JackknifeAngle(car.trailer()->params, car.params());
  const std::size_t count = log.rows.size();
  ASSERT_GT(count, 100U);
  EXPECT_GE(std::abs(log.rows[count - 1].trailer->angle), limit);
  EXPECT_LT(std::abs(log.rows[count - 2].trailer->angle), limit);
}

TEST(TrailerClearance, IsThatOfTheWiderTrailer) {
  const std::string obstacle =
      "world: {obstacles: [{box: {x: 12, y: 2.0, yaw: 0, length: 2, width: 1}}]}\n";
  const RunLog log = SimulatePlanned(Towing("fillet", "{width: 2.4}", obstacle), "kinematic");
  double smallest = 10.0;
  for (const LogRow& row : log.rows) {
    smallest = std::min(smallest, *row.clearance);
  }
  EXPECT_NEAR(smallest, 1.5 - 1.2, Tolerance(1e-9));
  EXPECT_EQ(log.status, DriveStatus::kArrived);
}

TEST(TrailerClearance, EndsTheRunOnContact) {
  const std::string obstacle =
      "world: {obstacles: [{box: {x: 12, y: 2.0, yaw: 0, length: 2, width: 1}}]}\n";
  for (const char* plant : {"kinematic", "mujoco:magic_formula"}) {
    const RunLog log = SimulatePlanned(Towing("fillet", "{width: 3.2}", obstacle), plant);
    EXPECT_EQ(log.status, DriveStatus::kCollided) << plant;
    // The front of the body meets the obstacle, which begins at x = 11 m, when the car's rear axle
    // is at 11 m plus hitch and front of the body: 0.914 + 2.7 - 1.335 m. The car has 2 m/s.
    const auto hit = std::find_if(log.rows.begin(), log.rows.end(),
                                  [](const LogRow& row) { return *row.clearance == 0.0; });
    ASSERT_NE(hit, log.rows.end()) << plant;
    EXPECT_NEAR(hit->state.pose.x, 13.279, Tolerance(0.05)) << plant;
  }
}

TEST(TrailerStart, IsRefusedInAnObstacle) {
  const Scenario scenario = Towing(
      "fillet", "{}", "world: {obstacles: [{box: {x: -4, y: 0, yaw: 0, length: 1, width: 1}}]}\n");
  EXPECT_THAT(StartOverlap(scenario, LoadCar(scenario).params()),
              testing::HasSubstr("overlaps the trailer of the car"));
}

// Braking and driving limits of the plan are those of car and trailer.
TEST(TrailerLimits, AreLowerThanThoseOfTheCar) {
  const VehicleParams alone = LoadCar(Towing("fillet", "")).unladen();
  const VehicleParams towing = LoadCar(Towing("fillet", "{mass: 658.5}")).unladen();
  // half the car's mass without brakes: the brakes' own limit falls to 2/3, but for the wheels
  EXPECT_NEAR(towing.braking.by_force / alone.braking.by_force, 2.0 / 3.0, Tolerance(0.01));
  EXPECT_LT(towing.max_deceleration, 0.75 * alone.max_deceleration);
  EXPECT_LT(towing.max_acceleration, alone.max_acceleration);
  EXPECT_LT(towing.top_speed, alone.top_speed);
}

}  // namespace drive_trailer_test
}  // namespace trackbed
