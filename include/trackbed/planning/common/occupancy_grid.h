#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trackbed/geometry/box_index.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"

/// A grid of square cells that are free or occupied, for searching paths in the plane.
namespace trackbed {

/// A grid of square cells in rows along the x axis of the grid. The area outside of the grid does
/// not count as free.
struct OccupancyGrid {
  /// Pose of the grid's frame, at the middle of cell 0. The column index grows along x, the row
  /// index along y.
  Pose2 X_WG;
  double cell = 1.0;  ///< Side length of a cell [m], > 0.
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> occupied;  ///< State of the cells, row by row; 1: occupied, 0: free.

  [[nodiscard]] std::size_t size() const { return occupied.size(); }

  /// Returns the middle of a cell in world coordinates [m].
  [[nodiscard]] Vec2 CellCenter(std::size_t index) const;

  /// Returns the index of the cell that contains a point given in world coordinates; -1 if the
  /// point is outside of the grid.
  [[nodiscard]] int CellAt(const Vec2& point_W) const;
};

/// A rectangle along the axes of some coordinate frame.
struct GridArea {
  Vec2 low{0.0, 0.0};   ///< Corner of the rectangle with the smallest x and y [m].
  Vec2 high{0.0, 0.0};  ///< Corner of the rectangle with the largest x and y [m].
};

/// Returns the smallest rectangle along the axes of the frame F that contains all points and boxes,
/// enlarged by `margin` [m] on every side.
GridArea AreaAround(const Pose2& X_WF, const std::vector<Vec2>& points_W,
                    const std::vector<OrientedBox>& boxes_W, double margin);

/// The maximum number of cells of a grid.
inline constexpr double kMaxCells = 2e7;

/// Returns the number of cells with the side length `cell` [m] that cover an area.
double CellsIn(const GridArea& area, double cell);

/// Makes a grid that covers an area given in the frame X_WF, with the middle of a cell at the
/// frame's origin. A cell is occupied if its middle is not farther from a box than `inflation`. The
/// computing time is proportional to the number of cells in all boxes, each enlarged by
/// `inflation`. Throws InternalError if the grid would have more than kMaxCells cells, and
/// PreconditionError if a box is not finite.
OccupancyGrid Rasterize(const Pose2& X_WF, const GridArea& area, double cell,
                        const std::vector<OrientedBox>& boxes_W, const Inflation& inflation);

}  // namespace trackbed
