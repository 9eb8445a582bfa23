#include "trackbed/world/map_obstacles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/error.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

// Rounding error [m] of a few operations on coordinates below 100 m.
constexpr double kMapRounding = 1e-12;

/// Returns a map drawn as rows of characters, with the top row first: '#' is an occupied cell, '?'
/// an unknown cell, and any other character a free cell.
GridMap Picture(const std::vector<std::string>& rows) {
  GridMap map{.X_WM = {},
              .cell = 1.0,
              .columns = static_cast<int>(rows.front().size()),
              .rows = static_cast<int>(rows.size()),
              .cells = {}};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char c : *row) {
      map.cells.push_back(c == '#'   ? MapCell::kOccupied
                          : c == '?' ? MapCell::kUnknown
                                     : MapCell::kFree);
    }
  }
  return map;
}

/// Returns a map with random size, pose and cells. The state changes from cell to cell with a
/// random probability, so occupied cells form groups.
GridMap RandomMap(Random& random) {
  GridMap map{
      .X_WM = {random.Uniform(-20.0, 20.0), random.Uniform(-20.0, 20.0), random.Uniform(-3.0, 3.0)},
      .cell = random.Uniform(0.1, 2.0),
      .columns = 1 + random.Below(40),
      .rows = 1 + random.Below(40),
      .cells = {}};
  const double change = random.Uniform(0.05, 1.0);
  MapCell now = MapCell::kFree;
  for (int i = 0; i < map.columns * map.rows; ++i) {
    if (random.Uniform(0.0, 1.0) < change) {
      now = static_cast<MapCell>(random.Below(3));
    }
    map.cells.push_back(now);
  }
  return map;
}

TEST(MergeCells, CoversBlockedCellsOnceAndNoOthers) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const GridMap map = RandomMap(random);
    for (const UnknownCells unknown : {UnknownCells::kFree, UnknownCells::kOccupied}) {
      std::vector<int> covered(map.cells.size(), 0);
      for (const CellRectangle& r : MergeCells(map, unknown)) {
        ASSERT_TRUE(r.column >= 0 && r.row >= 0 && r.columns > 0 && r.rows > 0 &&
                    r.column + r.columns <= map.columns && r.row + r.rows <= map.rows);
        for (int row = r.row; row < r.row + r.rows; ++row) {
          for (int column = r.column; column < r.column + r.columns; ++column) {
            ++covered[static_cast<std::size_t>(row * map.columns + column)];
          }
        }
      }
      for (std::size_t cell = 0; cell < covered.size(); ++cell) {
        const bool blocked =
            map.cells[cell] == MapCell::kOccupied ||
            (map.cells[cell] == MapCell::kUnknown && unknown == UnknownCells::kOccupied);
        ASSERT_EQ(covered[cell], blocked ? 1 : 0);
      }
    }
  }
}

TEST(MergeCells, MakesFewRectangles) {
  EXPECT_TRUE(MergeCells(Picture({"...", ".?."}), UnknownCells::kFree).empty());
  EXPECT_EQ(MergeCells(Picture({".##.", ".##.", ".??."}), UnknownCells::kOccupied),
            (std::vector<CellRectangle>{{1, 0, 2, 3}}));
  // MergeCells splits each L shape so that the longer stroke of the L is one rectangle.
  EXPECT_EQ(MergeCells(Picture({"#...", "#...", "####"}), UnknownCells::kFree),
            (std::vector<CellRectangle>{{0, 0, 4, 1}, {0, 1, 1, 2}}));
  EXPECT_EQ(MergeCells(Picture({"#..", "#..", "#..", "##."}), UnknownCells::kFree),
            (std::vector<CellRectangle>{{0, 0, 1, 4}, {1, 0, 1, 1}}));
}

TEST(MapObstacles, StandWhereTheCellsAre) {
  GridMap map = Picture({"#..", "..."});
  map.cell = 0.5;
  map.X_WM = {10.0, 20.0, 0.5 * std::acos(-1.0)};
  const MapObstacles obstacles(map, UnknownCells::kFree);
  ASSERT_EQ(obstacles.boxes().size(), 1U);
  // In map coordinates, the center of the occupied cell is (0.25, 0.75) m. The map's x axis points
  // north.
  EXPECT_NEAR(obstacles.boxes()[0].center.x, 10.0 - 0.75, Tolerance(kMapRounding));
  EXPECT_NEAR(obstacles.boxes()[0].center.y, 20.0 + 0.25, Tolerance(kMapRounding));
  EXPECT_EQ(obstacles.boxes()[0].length, 0.5);
  EXPECT_EQ(obstacles.boxes()[0].width, 0.5);
  map.cells.pop_back();
  EXPECT_THROW(MapObstacles(map, UnknownCells::kFree), InternalError);
}

TEST(MapObstacles, KeepTheCarAsFarAsEveryBlockedCellAlone) {
  const VehicleParams car = ReferenceCar();
  Random random(4);
  int touched = 0;
  for (int i = 0; i < 30; ++i) {
    const GridMap map = RandomMap(random);
    World mapped;
    mapped.map =
        MapSpec{.file = "", .data = std::make_shared<const MapObstacles>(map, UnknownCells::kFree)};
    World celled;
    for (int row = 0; row < map.rows; ++row) {
      for (int column = 0; column < map.columns; ++column) {
        if (map.At(column, row) == MapCell::kOccupied) {
          const Vec2 middle = ToWorld(map.X_WM, map.cell * Vec2{column + 0.5, row + 0.5});
          celled.obstacles.push_back(
              {.footprint = {{middle.x(), middle.y(), map.X_WM.yaw}, map.cell, map.cell}});
        }
      }
    }
    ASSERT_EQ(HasObstacles(mapped), HasObstacles(celled));
    for (int k = 0; k < 30; ++k) {
      const Pose2 pose{random.Uniform(-90.0, 90.0), random.Uniform(-90.0, 90.0),
                       random.Uniform(-4.0, 4.0)};
      const auto clearance = Clearance(mapped, car, pose, 0.0);
      const auto expected = Clearance(celled, car, pose, 0.0);
      ASSERT_EQ(clearance.has_value(), expected.has_value());
      if (expected) {
        EXPECT_NEAR(*clearance, *expected, Tolerance(kMapRounding));
        EXPECT_EQ(*clearance == 0.0, *expected == 0.0);
        touched += *expected == 0.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(touched, 10);
}

TEST(MapObstacles, AreApproachedAsBoxesAre) {
  const VehicleParams car = ReferenceCar();
  World mapped;
  mapped.map = MapSpec{.file = "",
                       .data = std::make_shared<const MapObstacles>(Picture({"...", "...", "..#"}),
                                                                    UnknownCells::kFree)};
  World boxed;
  boxed.obstacles.push_back({.footprint = {{2.5, 0.5, 0.0}, 1.0, 1.0}});
  const auto approach = [&](const World& world) {
    const Pose2 from{-20.0, 2.0, 0.0};
    const Pose2 to{20.0, 2.0, 0.1};
    return ApproachBetween(world, car, {from, 0.0, *Clearance(world, car, from, 0.0)},
                           {to, 1.0, *Clearance(world, car, to, 1.0)});
  };
  EXPECT_EQ(approach(mapped).clearance, approach(boxed).clearance);
  EXPECT_EQ(approach(mapped).time, approach(boxed).time);
  EXPECT_LT(approach(mapped).clearance, 1.0);
}

}  // namespace
}  // namespace trackbed
