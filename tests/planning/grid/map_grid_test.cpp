#include "trackbed/planning/grid/map_grid.h"

#include <gtest/gtest.h>

#include "tests/tolerance.h"

namespace trackbed {
namespace {

TEST(MapGrid, HasTheCellsOfTheMapWhereTheyAre) {
  const GridMap map{.X_WM = {5.0, -3.0, 0.6},
                    .cell = 0.5,
                    .columns = 3,
                    .rows = 2,
                    .cells = {MapCell::kFree, MapCell::kOccupied, MapCell::kUnknown, MapCell::kFree,
                              MapCell::kFree, MapCell::kOccupied}};
  const OccupancyGrid grid = ToOccupancyGrid(map, UnknownCells::kFree);
  EXPECT_EQ(grid.occupied, (std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(ToOccupancyGrid(map, UnknownCells::kOccupied).occupied,
            (std::vector<std::uint8_t>{0, 1, 1, 0, 0, 1}));
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const Vec2 middle = ToWorld(map.X_WM, 0.5 * Vec2{column + 0.5, row + 0.5});
      const int cell = row * map.columns + column;
      EXPECT_EQ(grid.CellAt(middle), cell);
      // Tolerance for rounding in a few operations on coordinates below 10 m.
      EXPECT_NEAR((grid.CellCenter(static_cast<std::size_t>(cell)) - middle).norm(), 0.0,
                  Tolerance(1e-14));
    }
  }
  EXPECT_EQ(grid.CellAt(ToWorld(map.X_WM, {-0.01, 0.2})), -1);
}

}  // namespace
}  // namespace trackbed
