#include "src/path_files/lanelet_orientation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace trackbed {
namespace {

LaneletBounds ByEnds(LaneletBounds bounds) {
  auto& [left, right] = bounds;
  const auto apart = [](const Vec2& a, const Vec2& b) { return (a - b).norm(); };
  const Vec2& first = left.points.front();
  const Vec2& last = left.points.back();
  if (apart(first, right.points.back()) + apart(last, right.points.front()) <
      apart(first, right.points.front()) + apart(last, right.points.back())) {
    right = right.Reversed();
  }
  // The ring that follows the right bound forward and the left bound backward is counter-clockwise.
  std::vector<Vec2> ring = right.points;
  ring.insert(ring.end(), left.points.rbegin(), left.points.rend());
  double area = 0.0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    area += Cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  }
  if (area < 0.0) {
    left = left.Reversed();
    right = right.Reversed();
  }
  return bounds;
}

/// Whether a point is to the left of a line, judged at the line's nearest point. At a corner of the
/// line, the sum of the unit normals of both edges decides.
bool IsLeftOf(const std::vector<Vec2>& line, const Vec2& point) {
  double least = std::numeric_limits<double>::infinity();
  Vec2 nearest = line.front();
  Vec2 normal = Vec2::Zero();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec2 edge = line[i] - line[i - 1];
    if (edge.squaredNorm() == 0.0) {
      continue;
    }
    const double share = std::clamp((point - line[i - 1]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    const Vec2 place = share < 1.0 ? Vec2(line[i - 1] + share * edge) : line[i];
    const double distance = (point - place).norm();
    if (distance < least) {
      nearest = place;
      normal = LeftNormal(edge.normalized());
      least = distance;
    } else if (place == nearest) {
      normal += LeftNormal(edge.normalized());
    }
  }
  return normal.dot(point - nearest) > 0.0;
}

LaneletBounds BySides(LaneletBounds bounds) {
  const auto middle = [](const std::vector<Vec2>& line) {
    return line.size() > 2 ? line[line.size() / 2] : Vec2(0.5 * (line.front() + line.back()));
  };
  if (IsLeftOf(bounds.left.points, middle(bounds.right.points))) {
    bounds.left = bounds.left.Reversed();
  }
  if (!IsLeftOf(bounds.right.points, middle(bounds.left.points))) {
    bounds.right = bounds.right.Reversed();
  }
  return bounds;
}

}  // namespace

void LaneletOrientation::Add(const LaneletBounds& bounds) {
  const LaneletBounds own = ByEnds(bounds);
  const LaneletBounds other = BySides(bounds);
  if (own.left.is_reversed == other.left.is_reversed &&
      own.right.is_reversed == other.right.is_reversed) {
    begins_.emplace(own.left.first, own.right.first);
    ends_.emplace(own.left.last, own.right.last);
  }
}

std::size_t LaneletOrientation::Joints(const LaneletBounds& bounds) const {
  return ends_.count({bounds.left.first, bounds.right.first}) +
         begins_.count({bounds.left.last, bounds.right.last});
}

LaneletBounds LaneletOrientation::Orient(const LaneletBounds& bounds) const {
  LaneletBounds own = ByEnds(bounds);
  if (Joints(own) > 0) {
    return own;
  }
  for (LaneletBounds other : {BySides(bounds), LaneletBounds{own.left.Reversed(), own.right},
                              LaneletBounds{own.left, own.right.Reversed()}}) {
    if (Joints(other) == 2) {
      return other;
    }
  }
  return own;
}

}  // namespace trackbed
