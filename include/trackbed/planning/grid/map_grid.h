#pragma once

#include "trackbed/planning/common/occupancy_grid.h"
#include "trackbed/world/grid_map.h"

namespace trackbed {

/// Converts the cells of a map to a grid for A* (astar.h). Obstacles are not inflated, so that
/// planned paths are paths of a point. The cell in a column and row of the map has the index row x
/// columns + column.
OccupancyGrid ToOccupancyGrid(const GridMap& map, UnknownCells unknown);

}  // namespace trackbed
