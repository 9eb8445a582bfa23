#include "trackbed/drive/start_overlap.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/vehicle/reference_car.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/grid/hybrid_astar.h"

// Tests the refusal of starts inside obstacles, and the hint how to leave obstacles to replanning
// during the run.
namespace trackbed {
namespace {

/// A mission of 100 m along x from the origin, with one obstacle 2 m long and wide.
Scenario ScenarioWith(double x, double y, const std::string& more,
                      const std::string& plan = "{method: dubins}") {
  return ParseScenario(
      fmt::format("schema: 1\nname: start\nmission: {{speed: 3, waypoints: [[0, 0], [100, 0]]}}\n"
                  "world: {{obstacles: [{{box: {{x: {}, y: {}, length: 2, width: 2, height: 1}}{}"
                  "}}]}}\nplan: {}\n",
                  x, y, more, plan),
      "start.yaml", "");
}

TEST(StartOverlap, NamesTheObstacleAndTheDepth) {
  const VehicleParams car = ReferenceCar();
  const double front = car.length - car.rear_overhang;
  // The obstacle extends from x - 1 m on. Moving the obstacle forward by the overlap frees the car.
  // Moving obstacles and obstacles that become known later are treated in the same way.
  for (const char* more : {"", ", velocity: {x: 5}", ", known_from: {time: 3}"}) {
    EXPECT_EQ(StartOverlap(ScenarioWith(front + 0.75, 0.2, more), car),
              fmt::format("world.obstacles[0] at ({:.4g}, 0.2) overlaps the car, which starts at "
                          "(0, 0), by 0.25 m; move one of them by at least this distance",
                          front + 0.75));
    EXPECT_EQ(StartOverlap(ScenarioWith(front + 1.0, 0.2, more), car), "");  // the obstacle touches
                                                                             // the car
  }
  EXPECT_NE(StartOverlap(ScenarioWith(0.0, -0.5 * car.width - 0.9, ""), car).find("by 0.1 m"),
            std::string::npos);
}

TEST(StartOverlap, RefusesTheRun) {
  for (const char* plan : {"{method: dubins}",
                           "{global: {method: dubins}, replan: {along: "
                           "{method: frenet}}}"}) {
    const Scenario scenario = ScenarioWith(1.0, 0.0, ", known_from: {time: 3}", plan);
    const FeasiblePlan refused = PlanScenario(scenario, ReferenceCar());
    EXPECT_EQ(refused->status, PlanStatus::kStartBlocked);
    EXPECT_EQ(refused->reason, StartOverlap(scenario, ReferenceCar()));
  }
}

TEST(PlanScenario, SaysHowToLeaveAnObstacleToReplanning) {
  // Arcs from and to poses on a line cannot pass the obstacle; curves with turned wheels can.
  const std::string arcs = "{method: dubins, curvature: steps}";
  const std::string replan = "{global: " + arcs + ", replan: {along: {method: frenet}}}";
  const FeasiblePlan refused = PlanScenario(ScenarioWith(50.0, 0.2, "", replan), ReferenceCar());
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused->reason.find("to leave an obstacle to plan.replan, give it known_from: {time: "
                                 "0.1}, or use a planner that ignores obstacles"),
            std::string::npos)
      << refused->reason;
  // Both remedies of the hint lead to a plan.
  EXPECT_TRUE(
      PlanScenario(ScenarioWith(50.0, 0.2, ", known_from: {time: 0.1}", replan), ReferenceCar())
          .ok());
  // If the car did not replan during the run, the remedies of the hint would be wrong.
  const FeasiblePlan alone = PlanScenario(ScenarioWith(50.0, 0.2, "", arcs), ReferenceCar());
  ASSERT_FALSE(alone.ok());
  EXPECT_EQ(alone->reason.find("known_from"), std::string::npos) << alone->reason;
}

/// Applies the remedies that the reason of a refused plan names, and plans again.
FeasiblePlan PlanWithRemedies(const std::string& reason, Scenario scenario) {
  if (reason.find("mission.start.speed: 0") != std::string::npos) {
    scenario.mission.start.speed = 0.0;
  }
  if (reason.find("plan: {method: hybrid_astar}") != std::string::npos) {
    scenario.plan->global = HybridAStarOptions{};
  }
  return PlanScenario(scenario, ReferenceCar());
}

// The obstacle is 1.4 m ahead of the front of a car that rolls at 3 m/s and that needs 3 m to stop
// at the mission's 1.5 m/s^2. From rest, the car can reverse.
TEST(PlanScenario, NamesRemediesThatWork) {
  for (const char* method : {"dubins", "reeds_shepp", "astar", "rrt", "rrt_star"}) {
    SCOPED_TRACE(method);
    const Scenario scenario = ScenarioWith(6.0, 0.2, "", fmt::format("{{method: {}}}", method));
    const FeasiblePlan refused = PlanScenario(scenario, ReferenceCar());
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused->reason.find("; there is a path with "), std::string::npos)
        << refused->reason;
    const FeasiblePlan mended = PlanWithRemedies(refused->reason, scenario);
    EXPECT_TRUE(mended.ok()) << refused->reason << "; then: " << mended->reason;
  }
}

// Headings that are rounded to milliradians turn a car of 9.65 m/s on a leg of 2.1 m faster than
// its wheels can.
TEST(PlanScenario, NamesHeadingsThatRefuseAPath) {
  Scenario scenario = ParseScenario(
      "schema: 1\nname: rounded\nvehicle: {model: prius}\nmission: {speed: 9.65, waypoints: "
      "[[0, 0], [3.03868, -2.174974], [4.735436, -3.389448], [17.055513, -12.2068]], headings: "
      "[-0.622, -0.62, -0.62, -0.621]}\nplan: {method: dubins}\n",
      "rounded.yaml", "");
  const FeasiblePlan refused = PlanScenario(scenario, LoadCar(scenario));
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused->reason.find("; there is a path without mission.headings"), std::string::npos)
      << refused->reason;
  scenario.mission.headings.clear();
  EXPECT_TRUE(PlanScenario(scenario, LoadCar(scenario)).ok());
}

// The remedy of a small car scales the cells of its search, but not below the smallest cell that
// the search allows: 0.5 m times 0.27 m / 4 m is 0.034 m for `dart`. The car stands in a closed
// box, so no planner has a plan.
TEST(PlanScenario, LooksForRemediesOfSmallCars) {
  for (const char* model : {"dart", "f1tenth"}) {
    for (const char* method : {"astar", "rrt", "dubins"}) {
      SCOPED_TRACE(fmt::format("{} {}", model, method));
      const auto wall = [](double x, double y, double length, double width) {
        return fmt::format("{{box: {{x: {}, y: {}, length: {}, width: {}, height: 1}}}}", x, y,
                           length, width);
      };
      const Scenario scenario = ParseScenario(
          fmt::format("schema: 1\nname: box\nvehicle: {{model: {}}}\nmission: {{speed: 1, start: "
                      "{{speed: 0.5}}, waypoints: [[0, 0], [8, 0]]}}\n"
                      "world: {{obstacles: [{}, {}, {}, {}]}}\nplan: {{method: {}}}\n",
                      model, wall(1.5, 0.0, 0.1, 3.0), wall(-1.5, 0.0, 0.1, 3.0),
                      wall(0.0, 1.5, 3.1, 0.1), wall(0.0, -1.5, 3.1, 0.1), method),
          "box.yaml", "");
      const FeasiblePlan refused = PlanScenario(scenario, LoadCar(scenario));
      ASSERT_FALSE(refused.ok());
      EXPECT_EQ(refused->reason.find("there is a path"), std::string::npos) << refused->reason;
    }
  }
}

TEST(PlanScenario, GivesNoHintWhereTheObstacleIsNotTheCause) {
  // A radius of 2 m is below the minimum of the car, with or without the obstacle.
  const FeasiblePlan refused = PlanScenario(
      ScenarioWith(50.0, 0.2, "",
                   "{global: {method: dubins, radius: 2}, replan: {along: {method: frenet}}}"),
      ReferenceCar());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused->reason.find("known_from"), std::string::npos) << refused->reason;
}

}  // namespace
}  // namespace trackbed
