#include <gtest/gtest.h>

#include <string>

#include "tests/tolerance.h"
#include "trackbed/planning/grid/astar_planner.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/scenario/scenario.h"

// Tests that default distances of planners follow from the size of the car.
namespace trackbed {
namespace car_lengths_test {

Scenario Read(const std::string& model, const std::string& plan) {
  return ParseScenario("schema: 1\nname: a\nvehicle: {model: " + model +
                           "}\nmission: {speed: 1, waypoints: [[0, 0], [9, 0]]}\nplan: " + plan +
                           "\n",
                       "a.yaml", TRACKBED_SOURCE_DIR "/tests/data");
}

template <typename Options>
Options Planner(const Scenario& scenario) {
  return scenario.plan->global.Get<Options>();
}

TEST(CarLengths, AreUnchangedForFullSizeCars) {
  for (const char* model : {"prius", "bmw320i"}) {
    const auto options = Planner<AStarOptions>(Read(model, "{method: astar}"));
    EXPECT_EQ(options.safe_distance, AStarOptions{}.safe_distance) << model;
    EXPECT_EQ(options.corner_room, AStarOptions{}.corner_room) << model;
    EXPECT_EQ(options.cell, AStarOptions{}.cell) << model;
    EXPECT_EQ(options.margin, AStarOptions{}.margin) << model;
  }
}

TEST(CarLengths, AreInProportionToSmallerCars) {
  // The model f1tenth is 0.58 m long, and full-size cars begin at 4 m.
  constexpr double kScale = 0.58 / 4.0;
  const auto grid = Planner<AStarOptions>(Read("f1tenth", "{method: astar}"));
  EXPECT_NEAR(grid.safe_distance, 0.3 * kScale, Tolerance(1e-12));
  EXPECT_NEAR(grid.corner_room, 1.0 * kScale, Tolerance(1e-12));
  EXPECT_NEAR(grid.cell, 0.5 * kScale, Tolerance(1e-12));
  EXPECT_NEAR(grid.margin, 10.0 * kScale, Tolerance(1e-12));
  EXPECT_EQ(grid.min_speed, AStarOptions{}.min_speed);
  const auto tree = Planner<RrtPlannerOptions>(Read("f1tenth", "{method: rrt}"));
  EXPECT_NEAR(tree.lead_in, RrtPlannerOptions{}.lead_in * kScale, Tolerance(1e-12));
  EXPECT_NEAR(tree.expand_distance, RrtPlannerOptions{}.expand_distance * kScale, Tolerance(1e-12));
  // The smallest cell that a scenario may have is 0.05 m; the car dart is 0.27 m long.
  EXPECT_EQ(Planner<AStarOptions>(Read("dart", "{method: astar}")).cell, 0.05);
}

TEST(CarLengths, KeepTheNumbersOfTheFile) {
  const auto options =
      Planner<AStarOptions>(Read("f1tenth", "{method: astar, corner_room: 1, cell: 0.2}"));
  EXPECT_EQ(options.corner_room, 1.0);
  EXPECT_EQ(options.cell, 0.2);
  // A resolved scenario states all numbers, so it is read again unchanged.
  const Scenario scenario = Read("f1tenth", "{method: astar}");
  const std::string resolved = ResolvedYaml(scenario);
  EXPECT_EQ(ResolvedYaml(ParseScenario(resolved, "b.yaml", ".")), resolved);
}

}  // namespace car_lengths_test
}  // namespace trackbed
