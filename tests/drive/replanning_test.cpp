#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "trackbed/drive/drive.h"

namespace trackbed {
namespace {

TEST(Replanning, KeepsAMotionThatLeadsPastWhatNewOnesDoNot) {
  // A box stands in the lane after the bend. The first lattice contains a motion that passes the
  // box. Later lattices have their layers at other stations, and contain no edge that passes the
  // box and that the wheels can follow.
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: lattice\n"
      "mission: {speed: 3, waypoints: [[0, 0], [30, 0], [60, 20], [60, 60]]}\n"
      "world: {obstacles: [{box: {x: 60, y: 42, length: 2, width: 1}, known_from: {range: "
      "25}}]}\n"
      "plan: {global: {method: fillet}, replan: {along: {method: lattice}, road: {left: 5, right: "
      "5}}}\ncontrol: {method: lqr}\ndrive: {plants: [kinematic]}\n",
      "lattice.yaml", ".");
  const CarModel car = LoadCar(scenario);
  const RunLog log =
      SimulateScenario(scenario, car, PlanScenario(scenario, car.unladen()), "kinematic");
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  EXPECT_GE(log.changes.size(), 1u);
}

TEST(Replanning, EndsWithACollision) {
  // A box at 60 m/s comes from the side and hits a car at 3 m/s, which would otherwise brake for
  // it.
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: struck\n"
      "mission: {speed: 3, waypoints: [[0, 0], [30, 0], [60, 1]]}\n"
      "world: {obstacles: [{box: {x: 12, y: -240, length: 4, width: 2}, velocity: {x: 0, y: 60}, "
      "known_from: {range: 90}}]}\n"
      "plan: {global: {method: fillet}, replan: {period: 0.2, along: {method: frenet}}}\n"
      "control: {method: preview}\ndrive: {plants: [mujoco]}\n",
      "struck.yaml", ".");
  const CarModel car = LoadCar(scenario);
  const RunLog log =
      SimulateScenario(scenario, car, PlanScenario(scenario, car.unladen()), "mujoco");
  EXPECT_EQ(log.status, DriveStatus::kCollided);
  ASSERT_TRUE(log.contact_time);
  EXPECT_GE(log.changes.size(), 1u);
  for (const PlanChange& change : log.changes) {
    EXPECT_LT(change.time, *log.contact_time);
  }
}

TEST(Replanning, GoesOnOnceWhatCrossesTheRoadIsGone) {
  // A pedestrian steps onto the road 17 m ahead and the car brakes. The path becomes free in the
  // same control period in which the car comes to rest, and the car continues.
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: crossing\nvehicle: {tyre: magic_formula}\n"
      "mission: {speed: 10, waypoints: [[0, 0], [80, 0]], start: {speed: 10}}\n"
      "world: {obstacles: [{box: {x: 50, y: -9, length: 0.6, width: 0.6}, velocity: {y: 1.5}, "
      "known_from: {range: 17}}]}\n"
      "plan: {global: {method: dubins}, replan: {period: 0.25, safe_distance: 0.8, road: {left: 3, "
      "right: 3}, along: {method: frenet}}}\n"
      "control: {method: preview}\ndrive: {plants: [mujoco]}\n",
      "crossing.yaml", ".");
  const CarModel car = LoadCar(scenario);
  const RunLog log =
      SimulateScenario(scenario, car, PlanScenario(scenario, car.unladen()), "mujoco");
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  const auto stands = [](const LogRow& row) { return std::abs(row.state.speed) < 0.01; };
  EXPECT_TRUE(std::any_of(log.rows.begin() + 100, log.rows.end() - 500, stands));
}

}  // namespace
}  // namespace trackbed
