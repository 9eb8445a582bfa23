#include "trackbed/geometry/box_index.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace index = boost::geometry::index;
using Point = boost::geometry::model::d2::point_xy<double>;
using Bounds = boost::geometry::model::box<Point>;
using Entry = std::pair<Bounds, std::size_t>;

/// Largest number of boxes for which the index uses a linear search instead of a tree.
constexpr std::size_t kMaxLinearSearch = 16;
/// Margin by which bounding boxes are enlarged for rounding errors, as a fraction of 1 m plus the
/// largest coordinate.
constexpr double kRounding = 1e-12;

bool IsFinite(const OrientedBox& box) {
  return box.center.position().allFinite() && std::isfinite(box.center.yaw) &&
         std::isfinite(box.length) && std::isfinite(box.width);
}

Bounds BoundsAround(Vec2 low, Vec2 high, double margin) {
  const double rounding =
      kRounding * (1.0 + std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()));
  low.array() -= margin + rounding;
  high.array() += margin + rounding;
  return {{low.x(), low.y()}, {high.x(), high.y()}};
}

Bounds BoundsOf(const OrientedBox& box) {
  const Vec2 along = 0.5 * box.length * Direction(box.center.yaw);
  const Vec2 across = 0.5 * box.width * LeftNormal(Direction(box.center.yaw));
  const Vec2 reach = along.cwiseAbs() + across.cwiseAbs();
  return BoundsAround(box.center.position() - reach, box.center.position() + reach, 0.0);
}

}  // namespace

struct BoxIndex::Tree {
  explicit Tree(const std::vector<Entry>& entries) : tree(entries) {}
  index::rtree<Entry, index::quadratic<16>> tree;
};

BoxIndex::BoxIndex(std::vector<OrientedBox> boxes) : boxes_(std::move(boxes)) {
  std::vector<Entry> entries;
  for (const OrientedBox& box : boxes_) {
    TRACKBED_REQUIRE(IsFinite(box),
                     "BoxIndex: a box of {} x {} m at {}, {}, yaw {}; must be finite", box.length,
                     box.width, box.center.x, box.center.y, box.center.yaw);
    if (boxes_.size() > kMaxLinearSearch) {
      entries.emplace_back(BoundsOf(box), entries.size());
    }
  }
  if (!entries.empty()) {
    tree_ = std::make_unique<Tree>(entries);
  }
}

BoxIndex::BoxIndex(BoxIndex&&) noexcept = default;
BoxIndex& BoxIndex::operator=(BoxIndex&&) noexcept = default;
BoxIndex::~BoxIndex() = default;

double BoxIndex::DistanceTo(const OrientedBox& box, double at_most) const {
  double nearest = at_most;
  if (!IsFinite(box)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (!tree_) {
    for (const OrientedBox& own : boxes_) {
      nearest = std::min(nearest, Distance(box, own));
    }
    return nearest;
  }
  const double radius = 0.5 * std::hypot(box.length, box.width);
  const Point center(box.center.x, box.center.y);
  const auto all = static_cast<unsigned>(boxes_.size());
  for (auto own = tree_->tree.qbegin(index::nearest(center, all)); own != tree_->tree.qend();
       ++own) {
    // Stop at the first box whose bounds are too far away, because the query returns boxes by
    // ascending distance of the bounds from the center.
    if (nearest == 0.0 || boost::geometry::distance(center, own->first) - radius >= nearest) {
      break;
    }
    nearest = std::min(nearest, Distance(box, boxes_[own->second]));
  }
  return nearest;
}

bool BoxIndex::KeepsFrom(const Vec2& from, const Vec2& to, const Inflation& inflation) const {
  const auto is_clear = [&](std::size_t box) {
    return Distance(from, to, boxes_[box]) > inflation.From(box);
  };
  if (!tree_) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (!is_clear(i)) {
        return false;
      }
    }
    return true;
  }
  const Bounds bounds = BoundsAround(from.cwiseMin(to), from.cwiseMax(to), inflation.most);
  return std::all_of(tree_->tree.qbegin(index::intersects(bounds)), tree_->tree.qend(),
                     [&](const Entry& near) { return is_clear(near.second); });
}

Inflation InflationAt(const std::vector<Vec2>& points, const std::vector<OrientedBox>& boxes,
                      double most) {
  // Tolerance [m] that exceeds the rounding errors of distances for coordinates of thousands of
  // kilometers.
  constexpr double kMoreThanRounding = 1e-9;
  Inflation inflation = most;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const Vec2& point : points) {
      const double distance = Distance(point, point, boxes[i]);
      if (distance <= inflation.From(i)) {
        inflation.own.resize(boxes.size(), most);
        inflation.own[i] = std::max(distance - kMoreThanRounding, 0.0);
      }
    }
  }
  return inflation;
}

}  // namespace trackbed
