#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trackbed/geometry/pose.h"

/// Maps that divide the plane into square cells, as robots and planning benchmarks use them.
namespace trackbed {

enum class MapCell : std::uint8_t { kFree, kOccupied, kUnknown };

/// Whether unknown cells of a map are treated as free or occupied.
enum class UnknownCells { kFree, kOccupied };

/// A map of square cells in rows along the map's x axis; the first row is at the bottom.
struct GridMap {
  /// Pose of the map's frame, whose origin is the outer corner of cell 0. The map's x axis points
  /// in the direction of growing columns, and the map's y axis in the direction of growing rows.
  Pose2 X_WM;
  double cell = 1.0;  ///< Length of a cell's side [m], > 0.
  int columns = 0;
  int rows = 0;
  std::vector<MapCell> cells;  ///< State of each map cell, row by row.

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

/// A rectangle of cells in a map.
struct CellRectangle {
  int column = 0;  ///< Column of the rectangle's left cells.
  int row = 0;     ///< Row of the rectangle's bottom cells.
  int columns = 0;
  int rows = 0;

  bool operator==(const CellRectangle&) const = default;
};

/// Returns rectangles that cover exactly the blocked cells, without overlap. The greedy method
/// visits the cells row by row. At each blocked cell that is not yet covered, the greedy method
/// places the larger of two rectangles: the widest possible one and the highest possible one. The
/// number of rectangles that MergeCells returns is small but not always minimal. The run time of
/// MergeCells is proportional to the number of cells.
std::vector<CellRectangle> MergeCells(const GridMap& map, UnknownCells unknown);

}  // namespace trackbed
