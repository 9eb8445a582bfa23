#include "render/ribbon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "render/decor.h"

namespace trackbed::render {
namespace {

/// Returns the distance between a point and a line segment, with vertical distances multiplied by
/// five.
double DistanceToSegment(const Point& p, const Point& a, const Point& b) {
  constexpr double kHeightWeight = 5.0;
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double along =
      squared > 0.0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - along * dx, p.y - a.y - along * dy,
                    kHeightWeight * (p.z - a.z - along * (b.z - a.z)));
}

bool Replaces(const std::vector<Point>& points, std::size_t first, std::size_t last,
              double tolerance) {
  for (std::size_t i = first + 1; i < last; ++i) {
    if (DistanceToSegment(points[i], points[first], points[last]) > tolerance) {
      return false;
    }
  }
  return true;
}

/// Thins the line greedily: makes each piece as long as the tolerance allows, by doubling its
/// length, then by bisection.
std::vector<std::size_t> ThinOnce(const std::vector<Point>& points, double tolerance) {
  constexpr std::size_t kMaxSkipped = 512;
  std::vector<std::size_t> kept{0};
  while (kept.back() + 1 < points.size()) {
    const std::size_t first = kept.back();
    const std::size_t limit = std::min(first + kMaxSkipped, points.size() - 1);
    std::size_t good = first + 1;
    std::size_t step = 1;
    while (good < limit && Replaces(points, first, std::min(good + step, limit), tolerance)) {
      good = std::min(good + step, limit);
      step *= 2;
    }
    std::size_t bad = good == limit ? limit + 1 : std::min(good + step, limit);
    while (bad - good > 1) {
      const std::size_t middle = good + (bad - good) / 2;
      (Replaces(points, first, middle, tolerance) ? good : bad) = middle;
    }
    kept.push_back(good);
  }
  return kept;
}

}  // namespace

std::vector<std::size_t> Thin(const std::vector<Point>& points, double tolerance,
                              std::size_t max_pieces) {
  if (points.empty()) {
    return {};
  }
  std::vector<std::size_t> kept = ThinOnce(points, tolerance);
  // After doubling 30 times, the tolerance of thinning is larger than any road.
  for (int doublings = 0; kept.size() > max_pieces + 1 && doublings < 30; ++doublings) {
    tolerance *= 2.0;
    kept = ThinOnce(points, tolerance);
  }
  return kept;
}

void AddRibbonPiece(mjvScene& scene, const Point& a, const Point& b, const RibbonStyle& style,
                    const Eigen::Vector3d& normal) {
  const Eigen::Vector3d along(b.x - a.x, b.y - a.y, b.z - a.z);
  const double length = along.norm();
  if (length < 1e-6) {
    return;
  }
  // Neighboring pieces of a line overlap, so they lie alternately at two heights to avoid
  // flickering. At equal heights, a lamp with shadows would light the overlap of two pieces twice.
  constexpr double kStagger = 0.0005;
  // The angle between neighboring pieces of a line is at most about 15 degrees. Overlapping the
  // pieces by tan(15/2 degrees) times half the line's width closes the gap at the outer corner.
  const double overlap = 0.15 * 0.5 * style.width;
  RowMajorMatrix3 rotation;
  rotation.col(0) = along / length;
  rotation.col(1) = normal.cross(along).normalized();
  rotation.col(2) = rotation.col(0).cross(rotation.col(1));
  const std::array<mjtNum, 3> size{0.5 * length + overlap, 0.5 * style.width, 1.0};
  const Eigen::Vector3d center = Eigen::Vector3d(a.x, a.y, a.z) + 0.5 * along +
                                 (style.height + (scene.ngeom % 2) * kStagger) * rotation.col(2);
  const std::array<float, 4> rgba{style.color.r, style.color.g, style.color.b, 1.0F};
  // The piece is drawn as a plane, which casts no shadow: MuJoCo draws back faces into its shadow
  // map, and a plane has no back face. A thin box would cast speckled shadows on its own upper
  // face, because the shadow map's depth is too coarse.
  if (mjvGeom* piece = AddDecor(scene, mjGEOM_PLANE, size, center, rotation, rgba)) {
    piece->emission = 0.08F;  // emission that keeps paint brighter than the road in the shade
  }
}

}  // namespace trackbed::render
