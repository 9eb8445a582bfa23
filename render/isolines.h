#pragma once

#include <functional>
#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed::render {

/// Computes contour lines of a function by marching squares. If the function is bilinear on each
/// square cell, the contour lines are exact on the cells' sides and straight in between.
///
/// The constructor evaluates the function `value` once at each corner of a cell. Square cells with
/// sides of length `step` [m] cover the rectangle from `low` to `high`. A contour line is either
/// closed or ends at the rectangle's sides; the last point of a closed line repeats the first. If
/// two opposite corners of a cell are above the contour level and the other two below, the middle
/// of the cell is treated as below the level. The run time for the contour lines is proportional to
/// the number of cells times the number of levels.
class IsolineGrid {
 public:
  IsolineGrid(const Vec2& low, const Vec2& high, double step,
              const std::function<double(const Vec2&)>& value);

  [[nodiscard]] std::vector<std::vector<Vec2>> At(double level) const;
  [[nodiscard]] double lowest() const;
  [[nodiscard]] double highest() const;

 private:
  [[nodiscard]] double Value(int column, int row) const {
    return values_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(column)];
  }
  /// Returns the index of the cell side that begins at a corner and runs along x (direction 0) or
  /// along y (direction 1).
  [[nodiscard]] int Side(int column, int row, int direction) const {
    return 2 * (row * columns_ + column) + direction;
  }
  [[nodiscard]] Vec2 Crossing(int side, double level) const;

  Vec2 low_;
  double step_;
  int columns_;  // number of cell corners along the grid's x axis
  int rows_;
  std::vector<double> values_;
};

}  // namespace trackbed::render
