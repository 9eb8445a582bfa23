#include "src/analysis/road_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/analysis/peaks.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr double kSpacing = 0.5;  // Spacing of stations and outline points [m].
constexpr double kBin = 8.0;      // Side of a square bin [m].

Vec2 PointAt(const Road& road, double s, double t) {
  const RoadPosition place = PositionAt(road, s, t);
  return {place.x, place.y};
}

/// Returns the signed distance of a point from the line between two other points, positive to the
/// left of the line [m]. LeftOf returns infinity if the two points of the line coincide, as where a
/// road turns about a point of its border.
double LeftOf(const std::pair<Vec2, Vec2>& line, const Vec2& point) {
  const Vec2 along = line.second - line.first;
  const double length = along.norm();
  return length > 0.0 ? Cross(along, point - line.first) / length
                      : std::numeric_limits<double>::infinity();
}

/// Returns points on the outline of a rectangle, at most kSpacing apart.
std::vector<Vec2> Outline(const OrientedBox& box) {
  std::vector<Vec2> points;
  const auto corners = box.Corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 side = corners[(i + 1) % corners.size()] - corners[i];
    const double count = std::max(std::ceil(side.norm() / kSpacing), 1.0);
    for (double k = 0.0; k < count; k += 1.0) {
      points.emplace_back(corners[i] + side * (k / count));
    }
  }
  return points;
}

}  // namespace

RoadBands::RoadBands(const RoadNetwork& network, const Vec2& low, const Vec2& high) {
  for (const auto& [id, road] : network.roads) {
    for (std::size_t section = 0; section < road.sections.size(); ++section) {
      if (OutermostLanes(road.sections[section]) != std::pair(0, 0)) {
        Add(road, road.sections[section].s, road.SectionEnd(section), low, high);
      }
    }
  }
  Sort();
}

void RoadBands::Add(const Road& road, double from, double to, const Vec2& low, const Vec2& high) {
  const std::size_t section = road.SectionAt(from);
  const auto [leftmost, rightmost] = OutermostLanes(road.sections[section]);
  const double count = std::max(std::ceil((to - from) / kSpacing), 1.0);
  std::pair<Vec2, Vec2> before{{0.0, 0.0}, {0.0, 0.0}};
  for (double i = 0.0; i <= count; i += 1.0) {
    const double s = std::lerp(from, to, i / count);
    const double piece_of = std::lerp(from, to, (i + (i < count ? 0.5 : -0.5)) / count);
    const LaneBorders left = LaneBordersAt(road, section, leftmost, s, piece_of);
    const LaneBorders right = LaneBordersAt(road, section, rightmost, s, piece_of);
    const std::pair<Vec2, Vec2> here{
        PointAt(road, s, rightmost > 0 ? right.inner.value : right.outer.value),
        PointAt(road, s, leftmost > 0 ? left.outer.value : left.inner.value)};
    const Vec2 least = here.first.cwiseMin(here.second).array() - kReach;
    const Vec2 most = here.first.cwiseMax(here.second).array() + kReach;
    if (i > 0.0 && (least.array() <= high.array()).all() && (most.array() >= low.array()).all()) {
      pieces_.push_back({{before.first, here.first}, {before.second, here.second}});
    }
    before = here;
  }
}

void RoadBands::Sort() {
  if (pieces_.empty()) {
    return;
  }
  const auto bounds = [](const Piece& piece) {
    const auto& [a, b] = piece.right;
    const auto& [c, d] = piece.left;
    return std::pair<Vec2, Vec2>(a.cwiseMin(b).cwiseMin(c).cwiseMin(d).array() - kReach,
                                 a.cwiseMax(b).cwiseMax(c).cwiseMax(d).array() + kReach);
  };
  low_ = bounds(pieces_.front()).first;
  Vec2 high = low_;
  for (const Piece& piece : pieces_) {
    low_ = low_.cwiseMin(bounds(piece).first);
    high = high.cwiseMax(bounds(piece).second);
  }
  columns_ = static_cast<int>((high.x() - low_.x()) / kBin) + 1;
  rows_ = static_cast<int>((high.y() - low_.y()) / kBin) + 1;
  bins_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const auto [from, to] = bounds(pieces_[i]);
    for (int row = BinOf(from.y(), low_.y(), rows_); row <= BinOf(to.y(), low_.y(), rows_); ++row) {
      for (int column = BinOf(from.x(), low_.x(), columns_);
           column <= BinOf(to.x(), low_.x(), columns_); ++column) {
        bins_[static_cast<std::size_t>(row * columns_ + column)].push_back(i);
      }
    }
  }
}

int RoadBands::BinOf(double along, double low, int count) const {
  return static_cast<int>(std::clamp(std::floor((along - low) / kBin), 0.0, count - 1.0));
}

std::optional<double> RoadBands::Inside(const Vec2& point) const {
  std::optional<double> inside;
  if (pieces_.empty()) {
    return inside;
  }
  const int bin =
      BinOf(point.y(), low_.y(), rows_) * columns_ + BinOf(point.x(), low_.x(), columns_);
  for (const std::size_t i : bins_[static_cast<std::size_t>(bin)]) {
    const Piece& piece = pieces_[i];
    // Tolerance for rounding errors at the line that two neighboring pieces of a band share [m].
    constexpr double kOverlap = 1e-6;
    if (LeftOf({piece.left.first, piece.right.first}, point) < -kOverlap ||
        LeftOf({piece.right.second, piece.left.second}, point) < -kOverlap) {
      continue;  // the point is before or beyond this piece of the band
    }
    const double distance =
        std::min(LeftOf(piece.right, point), LeftOf({piece.left.second, piece.left.first}, point));
    if (distance >= -kReach && std::isfinite(distance)) {
      inside = std::max(inside.value_or(distance), distance);
    }
  }
  return inside;
}

std::optional<MetricReading> SmallestRoadMargin(const MetricInput& input) {
  if (!input.plan.roads) {
    return std::nullopt;
  }
  std::vector<std::vector<Vec2>> outlines;
  Vec2 low = input.log.rows.front().state.pose.position();
  Vec2 high = low;
  for (const LogRow& row : input.log.rows) {
    outlines.push_back(Outline(FootprintAt(input.vehicle, row.state.pose)));
    if (const std::optional<OrientedBox> trailer = TrailerFootprint(input.log, row)) {
      const std::vector<Vec2> towed = Outline(*trailer);
      outlines.back().insert(outlines.back().end(), towed.begin(), towed.end());
    }
    for (const Vec2& point : outlines.back()) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  }
  const RoadBands bands(*input.plan.roads, low, high);
  std::optional<MetricReading> smallest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    for (const Vec2& point : outlines[i]) {
      const std::optional<double> inside = bands.Inside(point);
      if (inside && *inside < least) {
        const LogRow& row = input.log.rows[i];
        least = *inside;
        smallest = {least,
                    {.span = MetricSpan::kMoment, .s = RowStation(row), .t = row.state.time}};
      }
    }
  }
  return smallest;
}

}  // namespace trackbed
