#include <gtest/gtest.h>

#include <algorithm>

#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests the speed control on plans at the limit.
namespace trackbed {
namespace {

TEST(BrakingAtTheLimit, FollowsAPlanThatBrakesWithTheDrag) {
  // From 55 m/s, the plan brakes at 0.95 of the 8.26 m/s^2 of the tyres, and with the drag: 0.79
  // m/s^2 at 55 m/s. The car brakes as hard as the plan. The tyres' forces follow the slip within a
  // relaxation length of 0.3 m, 6 ms at 50 m/s, in which the plan's speed falls by 0.05 m/s. With
  // commands of at most 8.26 m/s^2, less than the plan above 38 m/s, the car was 0.18 m/s too fast.
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: brake\nvehicle: {model: prius, tyre: magic_formula}\n"
      "mission: {speed: 55, start: {speed: 55},\n"
      "  speed_profile: {method: limits, share: 0.95, jerk: 40}}\n"
      "plan: {method: straight, length: 400}\ndrive: {plants: [mujoco]}\n",
      "brake.yaml", ".");
  const CarModel car = LoadCar(scenario);
  const FeasiblePlan plan = PlanScenario(scenario, car.unladen());
  const RunLog log = SimulateScenario(scenario, car, plan, "mujoco");
  ASSERT_EQ(log.status, DriveStatus::kArrived);
  double most = 0.0;
  for (const LogRow& row : log.rows) {
    if (row.planned_speed) {
      most = std::max(most, row.state.speed - *row.planned_speed);
    }
  }
  EXPECT_LT(most, 0.06);
}

}  // namespace
}  // namespace trackbed
