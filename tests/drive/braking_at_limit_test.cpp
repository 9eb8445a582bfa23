#include <gtest/gtest.h>

#include <algorithm>

#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests the speed control on plans at the limit.
namespace trackbed {
namespace {

TEST(BrakingAtTheLimit, FollowsAPlanThatBrakesWithTheDrag) {
  // From 55 m/s, the plan brakes at 0.95 of the 8.26 m/s^2 of the tyres, and with the drag: 0.79
  // m/s^2 at 55 m/s. The car brakes as hard as the plan, so it stays as far above the plan as it
  // was when the jerk of 40 m/s^3 had built up the deceleration. A command limited to 8.26 m/s^2
  // would be less than the plan above 38 m/s, and the car 0.5 m/s too fast.
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
  double first = 0.0;
  double most = 0.0;
  for (const LogRow& row : log.rows) {
    if (!row.planned_speed) {
      continue;
    }
    const double over = row.state.speed - *row.planned_speed;
    (row.state.speed > 50.0 ? first : most) = std::max(row.state.speed > 50.0 ? first : most, over);
  }
  EXPECT_LT(first, 0.3);
  EXPECT_LT(most, first + 0.02);
}

}  // namespace
}  // namespace trackbed
