#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"

/// The plane in square cells, each free or not, for searches on a grid.
namespace trackbed {

/// Cells in rows along the grid's own x axis. Those beyond its border are not free.
struct OccupancyGrid {
  Pose2 X_WG;         ///< middle of cell 0; x along the columns, y along the rows
  double cell = 1.0;  ///< side of a cell [m], > 0
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> occupied;  ///< row by row; 1: occupied

  [[nodiscard]] std::size_t size() const { return occupied.size(); }

  /// The middle of a cell, in the world.
  [[nodiscard]] Vec2 CellCenter(std::size_t index) const;

  /// The cell around a point of the world, or -1 outside.
  [[nodiscard]] int CellAt(const Vec2& point_W) const;
};

/// The smallest rectangle along the axes of a frame.
struct GridArea {
  Vec2 low{0.0, 0.0};   ///< [m]
  Vec2 high{0.0, 0.0};  ///< [m]
};

/// What holds all points and boxes and `margin` [m] around, in the axes of `X_WF`.
GridArea AreaAround(const Pose2& X_WF, const std::vector<Vec2>& points_W,
                    const std::vector<OrientedBox>& boxes_W, double margin);

/// More cells than this are none to search.
inline constexpr double kMaxCells = 2e7;

/// How many cells cover an area.
double CellsIn(const GridArea& area, double cell);

/// A grid over an area of the frame X_WF, one cell's middle on the frame's origin. A cell is
/// occupied when its middle is not further than `inflation` [m] from a box. Cost: the cells of the
/// inflated boxes. InternalError for more than kMaxCells, PreconditionError for boxes
/// that are not finite.
OccupancyGrid Rasterize(const Pose2& X_WF, const GridArea& area, double cell,
                        const std::vector<OrientedBox>& boxes_W, double inflation);

}  // namespace trackbed
