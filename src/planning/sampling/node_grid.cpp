#include "src/planning/sampling/node_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trackbed {
namespace {

/// Mean number of nodes per cell above which the cells are divided, and the mean number after the
/// division.
constexpr double kMaxNodesPerCell = 16.0;
constexpr double kNodesPerCell = 4.0;

}  // namespace

NodeGrid::NodeGrid(const Vec2& low, const Vec2& high) : low_(low), high_(high), cells_(1) {
  Divide(1.0);
}

/// Divides the box into square cells; their number is between `cells` and three times `cells`.
void NodeGrid::Divide(double cells) {
  const Vec2 box = high_ - low_;
  side_ = std::max(std::sqrt(box.prod() / cells), box.maxCoeff() / cells);
  if (side_ == 0.0) {
    side_ = 1.0;  // the box is a single point
  }
  columns_ = static_cast<std::ptrdiff_t>(box.x() / side_) + 1;
  rows_ = static_cast<std::ptrdiff_t>(box.y() / side_) + 1;
  const std::vector<std::vector<Entry>> before = std::exchange(
      cells_, std::vector<std::vector<Entry>>(static_cast<std::size_t>(columns_ * rows_)));
  for (const std::vector<Entry>& cell : before) {
    for (const Entry& entry : cell) {
      const std::ptrdiff_t at = Row(entry.position.y()) * columns_ + Column(entry.position.x());
      cells_[static_cast<std::size_t>(at)].push_back(entry);
    }
  }
}

std::ptrdiff_t NodeGrid::Column(double x) const {
  return static_cast<std::ptrdiff_t>(
      std::clamp((x - low_.x()) / side_, 0.0, static_cast<double>(columns_ - 1)));
}

std::ptrdiff_t NodeGrid::Row(double y) const {
  return static_cast<std::ptrdiff_t>(
      std::clamp((y - low_.y()) / side_, 0.0, static_cast<double>(rows_ - 1)));
}

void NodeGrid::Add(const Vec2& position, std::size_t node) {
  const std::ptrdiff_t at = Row(position.y()) * columns_ + Column(position.x());
  cells_[static_cast<std::size_t>(at)].push_back({position, node});
  ++count_;
  const auto count = static_cast<double>(count_);
  if (count > kMaxNodesPerCell * static_cast<double>(cells_.size())) {
    Divide(count / kNodesPerCell);
  }
}

std::size_t NodeGrid::Nearest(const Vec2& p) const {
  const std::ptrdiff_t column = Column(p.x());
  const std::ptrdiff_t row = Row(p.y());
  Near nearest{std::numeric_limits<double>::infinity(), 0};
  // Search the rings of cells around the point's cell, from the inside out. Nodes outside the ring
  // with the number r are more than r cell sides away from the point.
  const std::ptrdiff_t rings = std::max(columns_, rows_);
  for (std::ptrdiff_t ring = 0; ring < rings; ++ring) {
    for (std::ptrdiff_t y = std::max(row - ring, std::ptrdiff_t{0});
         y <= std::min(row + ring, rows_ - 1); ++y) {
      const bool whole = std::abs(y - row) == ring;
      for (std::ptrdiff_t x = column - ring; x <= column + ring;
           x += whole || ring == 0 ? 1 : 2 * ring) {
        if (x < 0 || x >= columns_) {
          continue;
        }
        for (const Entry& entry : Cell(x, y)) {
          const double square = (entry.position - p).squaredNorm();
          if (square < nearest.square) {
            nearest = {square, entry.node};
          }
        }
      }
    }
    const double reach = static_cast<double>(ring) * side_;
    if (nearest.square <= reach * reach) {
      break;
    }
  }
  return nearest.node;
}

void NodeGrid::FindWithin(const Vec2& p, double radius, std::vector<Near>& near) const {
  near.clear();
  const double most = radius * radius;
  const std::ptrdiff_t right = Column(p.x() + radius);
  const std::ptrdiff_t top = Row(p.y() + radius);
  for (std::ptrdiff_t y = Row(p.y() - radius); y <= top; ++y) {
    for (std::ptrdiff_t x = Column(p.x() - radius); x <= right; ++x) {
      for (const Entry& entry : Cell(x, y)) {
        const double square = (entry.position - p).squaredNorm();
        if (square <= most) {
          near.push_back({square, entry.node});
        }
      }
    }
  }
}

void NodeGrid::FindNearest(const Vec2& p, std::size_t count, std::vector<Near>& near) const {
  // For evenly spread nodes, the first search circle contains a quarter more than `count` nodes. If
  // the search circle contains too few nodes, the circle is enlarged.
  const Vec2 box = high_ - low_;
  const double share = static_cast<double>(count) / static_cast<double>(count_);
  const double even = std::sqrt(1.25 * share * box.prod() / M_PI);
  for (double radius = std::max(even, 1e-3 * box.norm());; radius *= 1.5) {
    FindWithin(p, radius, near);
    if (near.size() >= std::min(count, count_)) {
      break;
    }
  }
  if (near.size() > count) {
    const auto end = near.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(near.begin(), end, near.end(),
                     [](const Near& a, const Near& b) { return a.square < b.square; });
    near.erase(end, near.end());
  }
}

}  // namespace trackbed
