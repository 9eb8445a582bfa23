#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Tests open-loop drives with plan.neutral_steering.
namespace trackbed {
namespace {

TEST(NeutralSteering, CarDrivesWhatItsPlanPredicts) {
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: neutral\n"
      "mission: {speed: 3, waypoints: [[0, 0], [40, 0], [40, 40], [80, 40]]}\n"
      "plan: {method: fillet, neutral_steering: 0.02, infeasible: allow}\n"
      "control: {method: schedule}\n"
      "drive: {plants: [kinematic], timestep: 0.001}\n",
      "test.yaml", ".");
  EXPECT_EQ(InitialState(scenario).steering, 0.02);
  const CarModel car = LoadCar(scenario);
  const FeasiblePlan plan = PlanScenario(scenario, car.unladen());
  ASSERT_TRUE(plan.ok()) << plan->reason;
  const RunLog log = SimulateScenario(scenario, car, plan, "kinematic");
  const LogRow& first = log.rows.front();
  const LogRow& last = log.rows.back();
  EXPECT_EQ(first.state.steering, 0.02);

  // The prediction is for the distance D_end at constant speed. The car stops within 1 mm of this
  // distance, and its steering ramps are divided into steps of 3 mm of travel. The tolerance covers
  // both errors.
  const auto predicted = DiagnosticsJson(plan).at("open_loop");
  const Pose2 goal = plan->reference.path.At(plan->reference.path.length()).pose;
  const double distance = (last.state.pose.position() - goal.position()).norm();
  EXPECT_GT(distance, 5.0);  // the legs are driven on a bend
  EXPECT_NEAR(distance, predicted.at("goal_distance_m").get<double>(), Tolerance(3e-3));
  EXPECT_NEAR(AngleDifference(last.state.pose.yaw, goal.yaw),
              predicted.at("goal_heading_error_rad").get<double>(), Tolerance(1e-3));
}

}  // namespace
}  // namespace trackbed
