#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trackbed/geometry/pose.h"

/// Maps of the plane in square cells, the usual format of robots and planning benchmarks.
namespace trackbed {

enum class MapCell : std::uint8_t { kFree, kOccupied, kUnknown };

/// How to treat unknown cells of a map.
enum class UnknownCells { kFree, kOccupied };

/// Cells in rows along the map's x axis, the first row at the bottom.
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
  /// Whether the cell is occupied, or unknown and treated as such.
  [[nodiscard]] bool IsBlocked(int column, int row, UnknownCells unknown) const {
    const MapCell is = At(column, row);
    return is == MapCell::kOccupied ||
           (is == MapCell::kUnknown && unknown == UnknownCells::kOccupied);
  }
};

/// A rectangle of cells.
struct CellRectangle {
  int column = 0;  ///< of its first cell
  int row = 0;     ///< of its first cell
  int columns = 0;
  int rows = 0;

  bool operator==(const CellRectangle&) const = default;
};

/// Covers the blocked cells exactly by rectangles without overlap. Greedy: the first remaining
/// blocked cell, in row order, gets the larger of two rectangles, the one that is as wide as
/// possible and the one that is as high as possible. The number of rectangles is small but not
/// minimal. Cost: O(cells).
std::vector<CellRectangle> MergeCells(const GridMap& map, UnknownCells unknown);

}  // namespace trackbed
