#include "trackbed/world/map_obstacles.h"

#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

std::vector<OrientedBox> Walls(const GridMap& map, UnknownCells unknown) {
  TRACKBED_CHECK(map.cell > 0.0 && map.columns > 0 && map.rows > 0 &&
                     map.cells.size() ==
                         static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows),
                 "a map of {} x {} cells of {} m has {}", map.columns, map.rows, map.cell,
                 map.cells.size());
  std::vector<OrientedBox> boxes;
  for (const CellRectangle& cells : MergeCells(map, unknown)) {
    const Vec2 middle = ToWorld(map.X_WM, map.cell * Vec2{cells.column + 0.5 * cells.columns,
                                                          cells.row + 0.5 * cells.rows});
    boxes.push_back(
        {{middle.x(), middle.y(), map.X_WM.yaw}, map.cell * cells.columns, map.cell * cells.rows});
  }
  return boxes;
}

}  // namespace

MapObstacles::MapObstacles(GridMap map, UnknownCells unknown)
    : map_(std::move(map)), index_(Walls(map_, unknown)) {}

}  // namespace trackbed
