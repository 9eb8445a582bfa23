#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/simulate_planned.h"
#include "trackbed/drive/drive.h"
#include "trackbed/world/map_obstacles.h"

// Tests drives toward the walls of a grid map.
namespace trackbed {
namespace {

/// A map of 60 x 60 m with its corner at (-10, -10) and cells of 2 m. Only the cells in the
/// rectangle `wall` are occupied.
MapSpec MapWith(const CellRectangle& wall) {
  constexpr int kSide = 30;
  GridMap map{.X_WM = {-10.0, -10.0, 0.0},
              .cell = 2.0,
              .columns = kSide,
              .rows = kSide,
              .cells = std::vector<MapCell>(kSide * kSide, MapCell::kFree)};
  for (int row = wall.row; row < wall.row + wall.rows; ++row) {
    for (int column = wall.column; column < wall.column + wall.columns; ++column) {
      map.cells[static_cast<std::size_t>(row * kSide + column)] = MapCell::kOccupied;
    }
  }
  return {.file = "",
          .height = 1.0,
          .data = std::make_shared<const MapObstacles>(std::move(map), UnknownCells::kFree)};
}

/// Returns a box obstacle that covers the rectangle `wall` of the map.
Obstacle BoxOf(const CellRectangle& wall) {
  return {.footprint = {{-10.0 + 2.0 * (wall.column + 0.5 * wall.columns),
                         -10.0 + 2.0 * (wall.row + 0.5 * wall.rows), 0.0},
                        2.0 * wall.columns,
                        2.0 * wall.rows},
          .height = 1.0};
}

Scenario Toward(const std::string& plan, const std::string& waypoints) {
  return ParseScenario(
      fmt::format("schema: 1\nname: walls\nmission: {{speed: 4, waypoints: {}}}\nplan: {}\n",
                  waypoints, plan),
      "test.yaml", ".");
}

TEST(MapWalls, AreHitAsBoxesAre) {
  // The wall is beside the route after a turn, and the car grazes it.
  constexpr CellRectangle kWall{22, 12, 3, 2};
  Scenario mapped = Toward("{method: fillet}", "[[0, 0], [36, 0], [36, 40]]");
  Scenario boxed = mapped;
  mapped.world.map = MapWith(kWall);
  boxed.world.obstacles = {BoxOf(kWall)};
  for (const char* plant : {"kinematic", "mujoco:magic_formula", "mujoco:contact"}) {
    SCOPED_TRACE(plant);
    const RunLog one = SimulatePlanned(mapped, plant);
    const RunLog other = SimulatePlanned(boxed, plant);
    EXPECT_EQ(one.status, DriveStatus::kCollided);
    EXPECT_EQ(one.status, other.status);
    EXPECT_EQ(one.contact_time, other.contact_time);
    ASSERT_EQ(one.rows.size(), other.rows.size());
    double force = 0.0;
    for (std::size_t i = 0; i < one.rows.size(); ++i) {
      EXPECT_EQ(one.rows[i].clearance, other.rows[i].clearance);
      EXPECT_EQ(one.rows[i].state.pose.x, other.rows[i].state.pose.x);
      EXPECT_EQ(one.rows[i].state.obstacle_force, other.rows[i].state.obstacle_force);
      force = std::max(force, one.rows[i].state.obstacle_force);
    }
    EXPECT_EQ(force > 0.0, std::string(plant) != "kinematic");
  }
}

TEST(MapWalls, ArePassedByPlannersThatSearch) {
  // The wall crosses the route, from y = -10 m to 42 m.
  constexpr CellRectangle kWall{15, 0, 1, 26};
  for (const char* planner : {"astar", "hybrid_astar", "rrt"}) {
    SCOPED_TRACE(planner);
    Scenario scenario = Toward(fmt::format("{{method: {}}}", planner), "[[-30, 0], [60, 0]]");
    scenario.mission.start.speed = 0.0;
    scenario.world.map = MapWith(kWall);
    const RunLog log = SimulatePlanned(scenario, "kinematic");
    EXPECT_EQ(log.status, DriveStatus::kArrived);
    for (const LogRow& row : log.rows) {
      ASSERT_GT(row.clearance.value_or(0.0), 0.0);
    }
  }
}

TEST(MapWalls, StopACarThatReplans) {
  constexpr CellRectangle kWall{20, 0, 1, 30};  // from x = 30 m on
  Scenario scenario = Toward(
      "{global: {method: dubins}, replan: {along: {method: frenet}, safe_distance: 0.5, "
      "road: {left: 3, right: 3}}}",
      "[[0, 0], [28, 0], [60, 0]]");
  scenario.world.map = MapWith(kWall);
  // Planning fails if the wall is known, because it blocks the path.
  const CarModel car = LoadCar(scenario);
  EXPECT_FALSE(PlanScenario(scenario, car.unladen()).ok());
  World empty;
  std::swap(scenario.world, empty);
  const FeasiblePlan straight = PlanScenario(scenario, car.unladen());
  std::swap(scenario.world, empty);
  for (const char* plant : {"kinematic", "mujoco:magic_formula"}) {
    const RunLog log = SimulateScenario(scenario, LoadCar(scenario), straight, plant);
    EXPECT_EQ(log.status, DriveStatus::kBlocked) << plant;
    for (const LogRow& row : log.rows) {
      // Between the samples of a motion, the distance to the wall may be up to 1 cm below the safe
      // distance of 0.5 m. The MuJoCo car may come closer by a few more centimeters.
      ASSERT_GT(row.clearance.value_or(0.0), 0.4) << plant;
    }
  }
}

}  // namespace
}  // namespace trackbed
