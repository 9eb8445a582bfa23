#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Index for neighbor queries among points in the plane, which are added one by one. The index
/// sorts the points into square cells and divides the cells as the number of points grows, so that
/// each cell contains only a few points.
///
/// Query results are exact except for rounding errors. The amortized cost of adding a point is
/// O(1). A query visits only the cells that overlap the search circle.
class NodeGrid {
 public:
  struct Entry {
    Vec2 position;
    std::size_t node;
  };
  struct Near {
    double square;  ///< square of the node's distance from the query point [m^2]
    std::size_t node;
  };

  /// Makes an empty index of points within the box with the corners `low` and `high`. The box may
  /// be degenerate: a line or a point.
  NodeGrid(const Vec2& low, const Vec2& high);

  void Add(const Vec2& position, std::size_t node);

  /// Returns the node nearest to the point `p`, which must lie in the box. The index must contain
  /// at least one node.
  [[nodiscard]] std::size_t Nearest(const Vec2& p) const;

  /// Finds all nodes within `radius` [m] of the point `p`. Stores the nodes in `near`, in no
  /// particular order.
  void FindWithin(const Vec2& p, double radius, std::vector<Near>& near) const;

  /// Finds the `count` nodes nearest to the point `p`, or all nodes if the index contains fewer.
  /// Stores the nodes in `near`, in no particular order.
  void FindNearest(const Vec2& p, std::size_t count, std::vector<Near>& near) const;

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
