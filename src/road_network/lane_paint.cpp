#include "trackbed/road_network/lane_paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace trackbed {
namespace {

constexpr double kWidth = 0.12;  // Width of a line [m].
constexpr double kDash = 3.0;    // Length of a dash [m].
constexpr double kLaneDashPeriod =
    9.0;  // Distance between the starts of two successive dashes [m].

/// Ends of a bound [cm].
using BoundEnds = std::array<long long, 4>;

BoundEnds EndsOf(const Vec2& first, const Vec2& last) {
  constexpr double kCentimeters = 100.0;
  const auto rounded = [](double meters) { return std::llround(kCentimeters * meters); };
  return {rounded(first.x()), rounded(first.y()), rounded(last.x()), rounded(last.y())};
}

/// Adds the dashes of a broken line.
void AddDashes(const std::vector<Vec2>& line, std::vector<PaintedLine>& lines) {
  double from = 0.0;  // Station of the first point of a line segment.
  PaintedLine dash{.points = {}, .width = kWidth};
  const auto finish = [&] {
    if (dash.points.size() > 1) {
      lines.push_back(dash);
    }
    dash.points.clear();
  };
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = (line[i + 1] - line[i]).norm();
    for (double s = 0.0; s < length;) {
      const double phase = std::fmod(from + s, kLaneDashPeriod);
      const double next = std::min(s + (phase < kDash ? kDash : kLaneDashPeriod) - phase, length);
      const auto at = [&](double part) -> Vec2 {
        return line[i] + part / length * (line[i + 1] - line[i]);
      };
      if (phase < kDash) {
        if (dash.points.empty()) {
          dash.points.push_back(at(s));
        }
        dash.points.push_back(at(next));
      } else {
        finish();
      }
      s = next > s ? next : length;  // the loop over the dashes must progress despite rounding
                                     // errors
    }
    from += length;
  }
  finish();
}

}  // namespace

RoadPaint PaintLanes(const DrawnLanes& lanes) {
  struct Bound {
    const std::vector<Vec2>* points;
    bool is_broken;
  };
  RoadPaint paint;
  std::map<BoundEnds, Bound> bounds;
  for (const DrawnLane& lane : lanes) {
    paint.bands.push_back({lane.left, lane.right});
    for (const std::vector<Vec2>* bound : {&lane.left, &lane.right}) {
      const BoundEnds ends = EndsOf(bound->front(), bound->back());
      if (bounds.count(EndsOf(bound->back(), bound->front())) > 0) {
        continue;  // a lane of the opposite direction has already added this lane boundary
      }
      const auto [own, is_new] = bounds.emplace(ends, Bound{bound, false});
      own->second.is_broken = !is_new;
    }
  }
  for (const auto& [ends, bound] : bounds) {
    if (bound.is_broken) {
      AddDashes(*bound.points, paint.lines);
    } else {
      paint.lines.push_back({.points = *bound.points, .width = kWidth});
    }
  }
  return paint;
}

}  // namespace trackbed
