#include "trackbed/planning/grid/map_grid.h"

namespace trackbed {

OccupancyGrid ToOccupancyGrid(const GridMap& map, UnknownCells unknown) {
  const Vec2 middle = ToWorld(map.X_WM, Vec2::Constant(0.5 * map.cell));
  OccupancyGrid grid{.X_WG = {middle.x(), middle.y(), map.X_WM.yaw},
                     .cell = map.cell,
                     .columns = map.columns,
                     .rows = map.rows,
                     .occupied = {}};
  grid.occupied.reserve(map.cells.size());
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      grid.occupied.push_back(map.IsBlocked(column, row, unknown) ? 1 : 0);
    }
  }
  return grid;
}

}  // namespace trackbed
