#pragma once

#include <functional>
#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed::render {

/// Contour lines of a function (marching squares). On square cells with a bilinear function, the
/// lines are exact on the cells' sides and straight in between.
///
/// `value` is evaluated once per cell corner; cells with sides of `step` [m] cover the rectangle
/// from `low` to `high`. A contour line ends at the rectangle's sides or closes; if closed, its
/// last point repeats the first. A cell with two opposite corners above the level and two below is
/// cut as if its middle were below. Cost of the contour lines: linear in the number of cells, times
/// the levels.
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
  /// Index of a cell side that begins at a corner: direction 0 along x, 1 along y.
  [[nodiscard]] int Side(int column, int row, int direction) const {
    return 2 * (row * columns_ + column) + direction;
  }
  [[nodiscard]] Vec2 Crossing(int side, double level) const;

  Vec2 low_;
  double step_;
  int columns_;  // number of corners along x
  int rows_;
  std::vector<double> values_;
};

}  // namespace trackbed::render
