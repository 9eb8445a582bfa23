#include "tests/audit/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace audit {
namespace {

double Dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y;
}

Point Minus(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y};
}

/// Largest gap between the quads along the outward normals of a's sides.
double LargestGapAlongSides(const Quad& a, const Quad& b) {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    const Point side = Minus(a[(i + 1) % 4], a[i]);
    const double length = std::hypot(side.x, side.y);
    const Point outward{side.y / length, -side.x / length};
    double nearest = std::numeric_limits<double>::infinity();
    for (const Point& corner : b) {
      nearest = std::min(nearest, Dot(outward, Minus(corner, a[i])));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

double NearestCorner(const Quad& corners, const Quad& sides) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Point& corner : corners) {
    for (std::size_t i = 0; i < 4; ++i) {
      nearest = std::min(nearest, DistanceToSegment(corner, sides[i], sides[(i + 1) % 4]));
    }
  }
  return nearest;
}

TimedPose Between(const TimedPose& a, const TimedPose& b, double share) {
  return {std::lerp(a.t, b.t, share), std::lerp(a.x, b.x, share), std::lerp(a.y, b.y, share),
          std::lerp(a.yaw, b.yaw, share)};
}

}  // namespace

double Rectangle::reach() const {
  return std::hypot(std::max(std::abs(back), std::abs(front)), 0.5 * width);
}

Quad CornersAt(const Rectangle& rectangle, const TimedPose& pose) {
  const double c = std::cos(pose.yaw);
  const double s = std::sin(pose.yaw);
  const auto at = [&](double x, double y) {
    return Point{pose.x + c * x - s * y, pose.y + s * x + c * y};
  };
  const double half = 0.5 * rectangle.width;
  return {at(rectangle.back, -half), at(rectangle.front, -half), at(rectangle.front, half),
          at(rectangle.back, half)};
}

double Gap(const Quad& a, const Quad& b) {
  const double along = std::max(LargestGapAlongSides(a, b), LargestGapAlongSides(b, a));
  if (along <= 0.0) {
    return along;
  }
  // The smallest distance between two disjoint convex polygons is at a corner of one of them.
  return std::min(NearestCorner(a, b), NearestCorner(b, a));
}

Quad Box::CornersAt(double t) const {
  const double passed = t - center.t;
  return audit::CornersAt(
      {-0.5 * length, 0.5 * length, width},
      {t, center.x + passed * velocity.x, center.y + passed * velocity.y, center.yaw});
}

Nearest SweptGap(const Rectangle& footprint, const std::vector<TimedPose>& poses, const Box& box,
                 double resolution) {
  Nearest nearest{.gap = std::numeric_limits<double>::infinity()};
  const double reach = footprint.reach();
  const double box_speed = std::hypot(box.velocity.x, box.velocity.y);
  double step = 0.0;
  const auto gap_at = [&](const TimedPose& pose) {
    const double gap = Gap(CornersAt(footprint, pose), box.CornersAt(pose.t));
    if (gap < nearest.gap) {
      nearest = {gap, pose.t, step};
    }
    return gap;
  };
  // While the body moves by `moved` relative to the obstacle, the gap changes by at most `moved`.
  // With the gaps g0 and g1 at the two ends, the gap in between is therefore at least (g0 + g1 -
  // moved)/2.
  const std::function<void(const TimedPose&, double, const TimedPose&, double, double)> look =
      [&](const TimedPose& from, double g0, const TimedPose& to, double g1, double moved) {
        if (!(moved > resolution) || 0.5 * (g0 + g1 - moved) >= nearest.gap) {
          return;
        }
        const TimedPose middle = Between(from, to, 0.5);
        const double gap = gap_at(middle);
        look(from, g0, middle, gap, 0.5 * moved);
        look(middle, gap, to, g1, 0.5 * moved);
      };
  double before = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) {
      const TimedPose& last = poses[i - 1];
      step = std::hypot(poses[i].x - last.x, poses[i].y - last.y) +
             reach * std::abs(poses[i].yaw - last.yaw) + box_speed * (poses[i].t - last.t);
    }
    const double gap = gap_at(poses[i]);
    if (i > 0) {
      look(poses[i - 1], before, poses[i], gap, step);
    }
    before = gap;
  }
  return nearest;
}

double DistanceToSegment(const Point& p, const Point& a, const Point& b) {
  const Point side = Minus(b, a);
  const Point to = Minus(p, a);
  const double squared = Dot(side, side);
  const double share = squared > 0.0 ? std::clamp(Dot(to, side) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(to.x - share * side.x, to.y - share * side.y);
}

Polyline::Polyline(std::vector<Point> points) : points_(std::move(points)) {
  if (points_.size() == 1) {
    points_.push_back(points_.front());
  }
}

double Polyline::DistanceTo(const Point& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    nearest = std::min(nearest, DistanceToSegment(p, points_[i], points_[i + 1]));
  }
  return nearest;
}

double Polyline::LocalDistanceTo(const Point& p) {
  constexpr std::size_t kBeside = 8;
  const std::size_t from = last_ - std::min(last_, kBeside);
  const std::size_t to = std::min(last_ + kBeside + 1, points_.size() - 1);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = from; i < to; ++i) {
    const double distance = DistanceToSegment(p, points_[i], points_[i + 1]);
    if (distance < nearest) {
      nearest = distance;
      last_ = i;
    }
  }
  return nearest;
}

}  // namespace audit
