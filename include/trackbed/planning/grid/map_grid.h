#pragma once

#include "trackbed/planning/common/occupancy_grid.h"
#include "trackbed/world/grid_map.h"

namespace trackbed {

/// Converts the cells of a map to an occupancy grid for A* (astar.h). The obstacles of the map are
/// not inflated, so that paths on the grid are paths of a point without extent. The map cell in
/// column c and row r has the index r x columns + c.
OccupancyGrid ToOccupancyGrid(const GridMap& map, UnknownCells unknown);

}  // namespace trackbed
