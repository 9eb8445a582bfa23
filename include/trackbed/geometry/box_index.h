#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "trackbed/geometry/oriented_box.h"

namespace trackbed {

/// Distances that line segments must keep from rectangles.
struct Inflation {
  /// Requires line segments to keep the same distance [m], >= 0, from every rectangle.
  Inflation(double distance) : most(distance) {}  // NOLINT(google-explicit-constructor)

  double most = 0.0;  ///< Largest of the required distances from the rectangles [m].
  /// Required distance from each rectangle [m], at most `most`; if empty, the distance is `most`
  /// for all rectangles.
  std::vector<double> own{};

  /// Returns the required distance from the rectangle with the index `box` [m].
  [[nodiscard]] double From(std::size_t box) const { return own.empty() ? most : own[box]; }
};

/// Returns the inflation of each rectangle [m]: the distance `most`, or less if one of the `points`
/// is nearer than `most` to the rectangle. With the returned inflation, a line that begins at one
/// of the `points` is free if the line comes no nearer to the rectangle than this point. A point
/// inside a rectangle is never free, however small the rectangle's inflation.
Inflation InflationAt(const std::vector<Vec2>& points, const std::vector<OrientedBox>& boxes,
                      double most);

/// Computes the distance to the nearest of many rectangles, using an R-tree (Guttman 1984) of the
/// rectangles' axis-aligned bounding boxes. The index cannot be changed after construction.
///
/// The R-tree only selects candidates; Distance() of oriented_box.h then computes the distances,
/// exactly except for rounding errors. Building the tree of n rectangles costs O(n log n): 2 ms for
/// 5000 rectangles. A query examines only nearby rectangles and takes a few microseconds in a tree
/// of 5000 rectangles.
class BoxIndex {
 public:
  BoxIndex() : BoxIndex(std::vector<OrientedBox>{}) {}
  /// Throws PreconditionError unless all numbers of the boxes are finite.
  explicit BoxIndex(std::vector<OrientedBox> boxes);
  BoxIndex(BoxIndex&&) noexcept;
  BoxIndex& operator=(BoxIndex&&) noexcept;
  ~BoxIndex();

  [[nodiscard]] const std::vector<OrientedBox>& boxes() const { return boxes_; }

  /// Returns the smallest distance from `box` to any rectangle of the index [m]; if the distance is
  /// larger than `at_most`, returns `at_most`. Returns NaN if `box` is not finite.
  [[nodiscard]] double DistanceTo(const OrientedBox& box,
                                  double at_most = std::numeric_limits<double>::infinity()) const;

  /// Whether the line segment between two points is farther from every rectangle than the
  /// inflation of the rectangle.
  [[nodiscard]] bool KeepsFrom(const Vec2& from, const Vec2& to, const Inflation& inflation) const;

 private:
  struct Tree;
  std::vector<OrientedBox> boxes_;
  // The R-tree; null if there are only few rectangles, because testing all of them is then faster.
  std::unique_ptr<Tree> tree_;
};

}  // namespace trackbed
