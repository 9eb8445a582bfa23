#include "src/track/track_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "src/track/smooth_line.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

/// Returns the plausible height of arcs over the steps before and after each point [m]
/// (FindDeviations). An arc of the angle t over the chord c is c t / 8 high; the angles of both
/// arcs add up to 2 phi.
std::vector<double> PlausibleHeights(const std::vector<TrackPoint>& points) {
  const std::size_t count = points.size();
  std::vector<double> heights;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2& here = points[i].position;
    const Vec2 before = here - points[(i + count - 1) % count].position;
    const Vec2 after = points[(i + 1) % count].position - here;
    const double a = before.norm();
    const double b = after.norm();
    const double turn = std::abs(std::atan2(Cross(before, after), before.dot(after)));
    heights.push_back(turn * a * b / (4.0 * (a + b)));
  }
  return heights;
}

double DistanceToSegment(const Vec2& point, const Vec2& from, const Vec2& to) {
  const Vec2 along = to - from;
  const double share = std::clamp(along.dot(point - from) / along.squaredNorm(), 0.0, 1.0);
  return (from + share * along - point).norm();
}

}  // namespace

LineDeviations FindDeviations(const std::vector<TrackPoint>& points, double smoothing,
                              double tolerance) {
  const SmoothLine line(points, smoothing);
  const std::vector<double> heights = PlausibleHeights(points);
  LineDeviations found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t next = (i + 1) % points.size();
    const Vec2& from = points[i].position;
    const Vec2& to = points[next].position;
    const double begin = line.parameters()[i];
    const double chord = line.chords()[i];
    found.largest = std::max(found.largest, (line.At(begin, 0) - from).norm());
    const double limit = std::max({tolerance, heights[i], heights[next]});
    const double parts = std::max(4.0, std::ceil(chord / line.knot_distance()));
    for (double k = 1.0; k < parts; k += 1.0) {
      if (DistanceToSegment(line.At(begin + chord * k / parts, 0), from, to) > limit) {
        found.swinging.push_back(i);
        break;
      }
    }
  }
  return found;
}

double ShortestStep(const std::vector<TrackPoint>& points, const std::vector<std::size_t>& steps) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const std::size_t i : steps) {
    shortest =
        std::min(shortest, (points[(i + 1) % points.size()].position - points[i].position).norm());
  }
  return shortest;
}

void AddMiddles(TrackRows& rows, const std::vector<std::size_t>& steps) {
  const std::size_t count = rows.points.size();
  std::vector<TrackPoint> points;
  std::vector<int> lines;
  auto step = steps.begin();
  for (std::size_t i = 0; i < count; ++i) {
    const TrackPoint& from = rows.points[i];
    points.push_back(from);
    lines.push_back(rows.lines[i]);
    if (step != steps.end() && *step == i) {
      const TrackPoint& to = rows.points[(i + 1) % count];
      points.push_back({0.5 * (from.position + to.position),
                        std::midpoint(from.width_right, to.width_right),
                        std::midpoint(from.width_left, to.width_left)});
      lines.push_back(rows.lines[i]);
      ++step;
    }
  }
  rows.points = std::move(points);
  rows.lines = std::move(lines);
}

}  // namespace trackbed
