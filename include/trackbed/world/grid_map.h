#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trackbed/geometry/pose.h"

/// A map of the plane in square cells, as robots make them and planners are compared on.
namespace trackbed {

enum class MapCell : std::uint8_t { kFree, kOccupied, kUnknown };

/// What becomes of cells that a map does not know.
enum class UnknownCells { kFree, kOccupied };

/// Cells in rows along the map's own x axis, the first row at the bottom.
struct GridMap {
  Pose2 X_WM;         ///< the outer corner of cell 0; x along the columns, y along the rows
  double cell = 1.0;  ///< side of a cell [m], > 0
  int columns = 0;
  int rows = 0;
  std::vector<MapCell> cells;  ///< row by row

  [[nodiscard]] MapCell At(int column, int row) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
  /// Whether nothing may be in the cell.
  [[nodiscard]] bool IsBlocked(int column, int row, UnknownCells unknown) const {
    const MapCell is = At(column, row);
    return is == MapCell::kOccupied ||
           (is == MapCell::kUnknown && unknown == UnknownCells::kOccupied);
  }
};

/// A rectangle of cells.
struct CellRectangle {
  int column = 0;  ///< of its first cell
  int row = 0;     ///< likewise
  int columns = 0;
  int rows = 0;

  bool operator==(const CellRectangle&) const = default;
};

/// Rectangles that cover the blocked cells and no others, none twice: of the blocked cells that are
/// left the first, in the order of the rows, gets the larger of the rectangle that is as wide as
/// possible and the one that is as high as possible. Few, but not the fewest. Cost: O(cells).
std::vector<CellRectangle> MergeCells(const GridMap& map, UnknownCells unknown);

}  // namespace trackbed
