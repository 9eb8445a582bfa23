#include "trackbed/world/grid_map.h"

#include <algorithm>

namespace trackbed {
namespace {

/// Stores which blocked cells of a grid map are not yet covered by a rectangle.
class OpenCells {
 public:
  OpenCells(const GridMap& map, UnknownCells unknown)
      : columns_(map.columns), rows_(map.rows), open_(map.cells.size()) {
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        open_[Index(column, row)] = map.IsBlocked(column, row, unknown) ? 1 : 0;
      }
    }
  }

  [[nodiscard]] bool IsOpen(int column, int row) const {
    return column < columns_ && row < rows_ && open_[Index(column, row)] != 0;
  }

  /// Returns the widest rectangle of open (not yet covered) cells that begins at a cell; of equally
  /// wide rectangles, returns the tallest.
  [[nodiscard]] CellRectangle Widest(int column, int row) const {
    CellRectangle found{column, row, 0, 1};
    while (IsOpen(column + found.columns, row)) {
      ++found.columns;
    }
    const auto row_is_open = [&](int next) {
      int i = 0;
      while (i < found.columns && IsOpen(column + i, next)) {
        ++i;
      }
      return i == found.columns;
    };
    while (row_is_open(row + found.rows)) {
      ++found.rows;
    }
    return found;
  }

  /// Returns the tallest rectangle of open (not yet covered) cells that begins at a cell; of
  /// equally tall rectangles, returns the widest.
  [[nodiscard]] CellRectangle Highest(int column, int row) const {
    CellRectangle found{column, row, 1, 0};
    while (IsOpen(column, row + found.rows)) {
      ++found.rows;
    }
    const auto column_is_open = [&](int next) {
      int i = 0;
      while (i < found.rows && IsOpen(next, row + i)) {
        ++i;
      }
      return i == found.rows;
    };
    while (column_is_open(column + found.columns)) {
      ++found.columns;
    }
    return found;
  }

  void Take(const CellRectangle& rectangle) {
    for (int row = 0; row < rectangle.rows; ++row) {
      const auto from =
          open_.begin() + static_cast<std::ptrdiff_t>(Index(rectangle.column, rectangle.row + row));
      std::fill_n(from, rectangle.columns, std::uint8_t{0});
    }
  }

 private:
  [[nodiscard]] std::size_t Index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  int columns_;
  int rows_;
  std::vector<std::uint8_t> open_;
};

}  // namespace

std::vector<CellRectangle> MergeCells(const GridMap& map, UnknownCells unknown) {
  OpenCells open(map, unknown);
  std::vector<CellRectangle> found;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      if (!open.IsOpen(column, row)) {
        continue;
      }
      const CellRectangle wide = open.Widest(column, row);
      const CellRectangle high = open.Highest(column, row);
      const auto area = [](const CellRectangle& r) {
        return static_cast<std::int64_t>(r.columns) * r.rows;
      };
      found.push_back(area(high) > area(wide) ? high : wide);
      open.Take(found.back());
    }
  }
  return found;
}

}  // namespace trackbed
