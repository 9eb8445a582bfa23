#include "trackbed/geometry/oriented_box.h"

#include <algorithm>
#include <cmath>

namespace trackbed {
namespace {

/// Half length x and half width y of a box.
struct HalfSizes {
  double x;
  double y;

  explicit HalfSizes(const OrientedBox& box) : x(0.5 * box.length), y(0.5 * box.width) {}
};

/// Returns the squared distance from a point, given in the frame of the box, to the box; 0 inside
/// the box.
double SquareToPoint(const HalfSizes& half, const Vec2& p) {
  const double x = std::max(std::abs(p.x()) - half.x, 0.0);
  const double y = std::max(std::abs(p.y()) - half.y, 0.0);
  return x * x + y * y;
}

}  // namespace

std::array<Vec2, 4> OrientedBox::Corners() const {
  const double x = 0.5 * length;
  const double y = 0.5 * width;
  return {ToWorld(center, {x, y}), ToWorld(center, {-x, y}), ToWorld(center, {-x, -y}),
          ToWorld(center, {x, -y})};
}

OrientedBox MovingBox::At(double time) const {
  OrientedBox moved = box;
  moved.center.x += velocity.x() * time;
  moved.center.y += velocity.y() * time;
  return moved;
}

bool Contains(const OrientedBox& box, const Vec2& point) {
  return SquareToPoint(HalfSizes(box), ToLocal(box.center, point)) == 0.0;
}

double Separation(const OrientedBox& a, const OrientedBox& b) {
  const HalfSizes half_a(a);
  const HalfSizes half_b(b);
  const Vec2 b_in_a = ToLocal(a.center, b.center.position());
  const double turn = b.center.yaw - a.center.yaw;
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  const Vec2 a_in_b{-c * b_in_a.x() - s * b_in_a.y(), s * b_in_a.x() - c * b_in_a.y()};
  // Return NaN if any input is NaN, because std::max below ignores a NaN that is not its first
  // argument.
  const double all = b_in_a.x() + b_in_a.y() + turn + half_a.x + half_a.y + half_b.x + half_b.y;
  if (std::isnan(all)) {
    return all;
  }
  const double along = std::abs(c);
  const double across = std::abs(s);
  // Compute the largest gap between the two boxes along the axes of both boxes. The two boxes are
  // disjoint if the largest gap is positive.
  const double gap =
      std::max({std::abs(b_in_a.x()) - half_a.x - along * half_b.x - across * half_b.y,
                std::abs(b_in_a.y()) - half_a.y - across * half_b.x - along * half_b.y,
                std::abs(a_in_b.x()) - half_b.x - along * half_a.x - across * half_a.y,
                std::abs(a_in_b.y()) - half_b.y - across * half_a.x - along * half_a.y});
  if (gap <= 0.0) {
    return gap;
  }
  // Check only the corners, because for disjoint boxes, one of the two nearest points is a corner.
  double square = b_in_a.squaredNorm();
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const Vec2 of_a{x * half_a.x, y * half_a.y};
      const Vec2 of_b{x * half_b.x, y * half_b.y};
      const Vec2 of_b_in_a =
          b_in_a + Vec2{c * of_b.x() - s * of_b.y(), s * of_b.x() + c * of_b.y()};
      const Vec2 of_a_in_b =
          a_in_b + Vec2{c * of_a.x() + s * of_a.y(), -s * of_a.x() + c * of_a.y()};
      square =
          std::min({square, SquareToPoint(half_a, of_b_in_a), SquareToPoint(half_b, of_a_in_b)});
    }
  }
  return std::sqrt(square);
}

double Distance(const OrientedBox& a, const OrientedBox& b) {
  return std::max(Separation(a, b), 0.0);
}

double Distance(const Vec2& from, const Vec2& to, const OrientedBox& box) {
  const HalfSizes half(box);
  const Vec2 p = ToLocal(box.center, from);
  const Vec2 q = ToLocal(box.center, to);
  const Vec2 middle = 0.5 * (p + q);
  const Vec2 along = 0.5 * (q - p);
  // A line segment and a box are disjoint only if an axis of the box or the normal of the segment
  // is a separating axis.
  const Vec2 reach{std::abs(along.x()), std::abs(along.y())};
  if (std::abs(middle.x()) <= half.x + reach.x() && std::abs(middle.y()) <= half.y + reach.y() &&
      std::abs(Cross(along, middle)) <= half.x * reach.y() + half.y * reach.x()) {
    return 0.0;
  }
  double square = std::min(SquareToPoint(half, p), SquareToPoint(half, q));
  const double length_square = along.squaredNorm();
  if (length_square > 0.0) {
    for (const double x : {-half.x, half.x}) {
      for (const double y : {-half.y, half.y}) {
        const Vec2 corner{x, y};
        const double t = std::clamp((corner - middle).dot(along) / length_square, -1.0, 1.0);
        square = std::min(square, (middle + t * along - corner).squaredNorm());
      }
    }
  }
  return std::sqrt(square);
}

}  // namespace trackbed
