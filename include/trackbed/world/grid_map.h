#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trackbed/geometry/pose.h"

/// Maps of the plane in square cells, the usual format of robots and planning benchmarks.
namespace trackbed {

enum class MapCell : std::uint8_t { kFree, kOccupied, kUnknown };

/// The treatment of unknown cells of a map.
enum class UnknownCells { kFree, kOccupied };

/// A map of cells in rows along its x axis, the first row at the bottom.
struct GridMap {
  Pose2 X_WM;  ///< Pose of the outer corner of cell 0; x along the columns, y along the rows.
  double cell = 1.0;  ///< Side of a cell [m], > 0.
  int columns = 0;
  int rows = 0;
  std::vector<MapCell> cells;  ///< Cells, row by row.

  [[nodiscard]] MapCell At(int column, int row) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
  /// Whether the cell is occupied, or unknown and treated as occupied.
  [[nodiscard]] bool IsBlocked(int column, int row, UnknownCells unknown) const {
    const MapCell is = At(column, row);
    return is == MapCell::kOccupied ||
           (is == MapCell::kUnknown && unknown == UnknownCells::kOccupied);
  }
};

/// A rectangle of cells.
struct CellRectangle {
  int column = 0;  ///< Column of the first cell.
  int row = 0;     ///< Row of the first cell.
  int columns = 0;
  int rows = 0;

  bool operator==(const CellRectangle&) const = default;
};

/// Covers the blocked cells exactly by rectangles without overlap. The method is greedy. At the
/// first remaining blocked cell in row order, the function places the larger of two rectangles: the
/// widest possible one and the highest possible one. The number of rectangles is small but not
/// minimal. Cost: O(cells).
std::vector<CellRectangle> MergeCells(const GridMap& map, UnknownCells unknown);

}  // namespace trackbed
