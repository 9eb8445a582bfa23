#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "trackbed/geometry/oriented_box.h"

namespace trackbed {

/// Finds the nearest of many rectangles, by an R-tree (Guttman 1984) of the rectangles'
/// axis-aligned bounds. The index is immutable.
///
/// All distances are computed by Distance() of oriented_box.h, exact to rounding; the tree only
/// selects candidates. Cost: O(n log n) to build the tree, 2 ms for 5000 rectangles. A query
/// examines only nearby rectangles and takes a few microseconds in a tree of 5000 rectangles.
class BoxIndex {
 public:
  BoxIndex() : BoxIndex(std::vector<OrientedBox>{}) {}
  /// PreconditionError unless the boxes are finite.
  explicit BoxIndex(std::vector<OrientedBox> boxes);
  BoxIndex(BoxIndex&&) noexcept;
  BoxIndex& operator=(BoxIndex&&) noexcept;
  ~BoxIndex();

  [[nodiscard]] const std::vector<OrientedBox>& boxes() const { return boxes_; }

  /// Returns the smallest distance from `box` to any rectangle of the index [m], but at most
  /// `at_most`. NaN if `box` is not finite.
  [[nodiscard]] double DistanceTo(const OrientedBox& box,
                                  double at_most = std::numeric_limits<double>::infinity()) const;

  /// Whether the segment between two points is more than `distance` [m] away from every box.
  [[nodiscard]] bool KeepsFrom(const Vec2& from, const Vec2& to, double distance) const;

 private:
  struct Tree;
  std::vector<OrientedBox> boxes_;
  std::unique_ptr<Tree> tree_;  // Null for few boxes, because testing all boxes is then faster.
};

}  // namespace trackbed
