#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Square-cell index of points in the plane for neighbor queries. The points are added to the index
/// one by one. The index divides cells as they fill, so that each cell holds a few points.
///
/// Distances are exact to rounding. Adding a point costs O(1) amortized. A query visits the cells
/// that its circle touches.
class NodeGrid {
 public:
  struct Entry {
    Vec2 position;
    std::size_t node;
  };
  struct Near {
    double square;  ///< square of the distance [m^2]
    std::size_t node;
  };

  /// All points lie within the box between two corners. The box may be a line or a point.
  NodeGrid(const Vec2& low, const Vec2& high);

  void Add(const Vec2& position, std::size_t node);

  /// The node nearest to a point of the box. The index must not be empty.
  [[nodiscard]] std::size_t Nearest(const Vec2& p) const;

  /// Replaces `near` by all nodes within `radius` [m] of a point, in no particular order.
  void FindWithin(const Vec2& p, double radius, std::vector<Near>& near) const;

 private:
  [[nodiscard]] std::ptrdiff_t Column(double x) const;
  [[nodiscard]] std::ptrdiff_t Row(double y) const;
  [[nodiscard]] const std::vector<Entry>& Cell(std::ptrdiff_t column, std::ptrdiff_t row) const {
    return cells_[static_cast<std::size_t>(row * columns_ + column)];
  }
  void Divide(double cells);

  Vec2 low_;
  Vec2 high_;
  double side_ = 1.0;  // side length of a cell [m]
  std::ptrdiff_t columns_ = 1;
  std::ptrdiff_t rows_ = 1;
  std::vector<std::vector<Entry>> cells_;
  std::size_t count_ = 0;
};

}  // namespace trackbed
