#include <gtest/gtest.h>

#include "trackbed/drive/drive.h"

namespace trackbed {
namespace {

TEST(Replanning, KeepsAMotionThatLeadsPastWhatNewOnesDoNot) {
  // After the bend a box stands in the lane. The first lattice leads past it; the next ones, whose
  // layers lie elsewhere, have no edge there that the wheels can follow.
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: lattice\n"
      "mission: {speed: 3, waypoints: [[0, 0], [30, 0], [60, 20], [60, 60]]}\n"
      "world: {obstacles: [{box: {x: 60, y: 42, length: 2, width: 1}, known_from: {range: 25}}]}\n"
      "plan: {global: {method: fillet}, replan: {along: {method: lattice}, road: {left: 5, right: "
      "5}}}\ncontrol: {method: preview}\ndrive: {plants: [kinematic]}\n",
      "lattice.yaml", ".");
  const CarModel car = LoadCar(scenario);
  const RunLog log = DrivePlant(scenario, car, PlanMission(scenario, car.unladen()), "kinematic");
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  EXPECT_GE(log.changes.size(), 1u);
}

}  // namespace
}  // namespace trackbed
