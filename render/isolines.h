#pragma once

#include <functional>
#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed::render {

/// Lines along which a function has one value. Where it is bilinear between the corners of square
/// cells the lines are exact on the cells' sides, and straight between those.
///
/// `value` is asked once per corner of the cells with sides of `step` [m] that cover the rectangle
/// from `low` to `high`. Lines end at the rectangle's sides or close: then their first point comes
/// again as the last. A cell whose opposite corners are both above and whose others are both below
/// is cut as if its middle were below. Cost linear in cells, times the levels.
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
  /// Side of a cell that begins at a corner: 0 along x, 1 along y.
  [[nodiscard]] int Side(int column, int row, int direction) const {
    return 2 * (row * columns_ + column) + direction;
  }
  [[nodiscard]] Vec2 Crossing(int side, double level) const;

  Vec2 low_;
  double step_;
  int columns_;  // of corners
  int rows_;
  std::vector<double> values_;
};

}  // namespace trackbed::render
