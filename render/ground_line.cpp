#include "render/ground_line.h"

#include <cmath>
#include <numeric>

namespace trackbed::render {
namespace {

// Maximum deviation of a thinned line from the original line [m]: a twentieth of the narrowest
// ribbon's width.
constexpr double kLineTolerance = 0.005;
constexpr std::size_t kMaxPieces = 3000;  // Maximum number of pieces into which a line is divided.
// Distance from the camera's target beyond which paint would be thinner than a pixel [m].
constexpr double kPaintRange = 250.0;

bool IsNear(const Point& a, const Point& b, const CameraPose& camera) {
  const double reach = kPaintRange + std::hypot(b.x - a.x, b.y - a.y);
  return std::hypot(a.x - camera.target_x, a.y - camera.target_y) < reach;
}

}  // namespace

std::vector<std::size_t> KeptPoints(const std::vector<Point>& line) {
  return Thin(line, kLineTolerance, kMaxPieces);
}

std::vector<Point> Thinned(const std::vector<Point>& line) {
  std::vector<Point> points;
  for (const std::size_t i : KeptPoints(line)) {
    points.push_back(line[i]);
  }
  return points;
}

std::size_t PointCount(const std::vector<std::vector<Point>>& lines) {
  return std::accumulate(
      lines.begin(), lines.end(), std::size_t{0},
      [](std::size_t sum, const std::vector<Point>& line) { return sum + line.size(); });
}

std::vector<Point> Outline(const Recording& recording, const std::array<Vec2, 4>& corners) {
  // The pieces of a line on uneven ground are short enough to follow the surface.
  const double longest = IsFlat(recording.world.ground) ? 1e6 : 0.25;
  std::vector<Point> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 side = corners[(i + 1) % corners.size()] - corners[i];
    const auto pieces = static_cast<int>(std::ceil(side.norm() / longest));
    for (int piece = 0; piece < pieces; ++piece) {
      const Vec2 p = corners[i] + side * (static_cast<double>(piece) / pieces);
      points.push_back(recording.OnGround({p.x(), p.y()}));
    }
  }
  points.push_back(points.front());
  return points;
}

void AddPiece(SceneContext& context, const World& world, const Point& a, const Point& b,
              const RibbonStyle& style) {
  if (IsNear(a, b, context.camera)) {
    AddRibbonPiece(context.scene, a, b, style,
                   GroundNormal(world, {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}));
  }
}

void AddLine(SceneContext& context, const World& world, const std::vector<Point>& points,
             const RibbonStyle& style) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    AddPiece(context, world, points[i - 1], points[i], style);
  }
}

}  // namespace trackbed::render
