#include "trackbed/planning/lanes/route_ground.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "src/planning/lanes/coarse_ground.h"
#include "src/planning/lanes/road_strip.h"
#include "src/planning/lanes/surface_error.h"
#include "trackbed/core/error.h"

// Makes a smooth terrain from the road surfaces along a route. First, the algorithm cuts the
// required stretches of road, extended at both ends, into short strips. A coarse terrain
// interpolates the heights of points on the lanes. Away from the lanes, the terrain slopes to a
// level border. Blocks of the terrain near the roads are refined: on a lane, the terrain has the
// height of this lane. Beside lanes, the terrain has the mean height of the lanes, weighted by
// proximity, and blends into the coarse terrain within 9.5 m. The algorithm refuses routes whose
// lanes cross at different heights, and routes that deviate from the terrain by over 1 cm.

namespace trackbed {
namespace {

// Length by which a road is included before and after the route [m].
constexpr double kRoadExtension = 15.0;
// Length by which a road is extended straight beyond its end [m].
constexpr double kStraightExtension = 6.0;
constexpr double kLaneSurfaceMargin = 1.5;  // Width by which a road surface extends beyond its
                                            // lanes [m].
constexpr double kBlendWidth = 8.0;  // Width of the transition from a road surface to the coarse
                                     // terrain [m].
constexpr double kInfluenceDistance = kLaneSurfaceMargin + kBlendWidth;
constexpr double kMargin = 128.0;        // Width of the terrain's margin around the route [m].
constexpr double kLevelBorder = 24.0;    // Width of the level border of the terrain [m].
constexpr double kSlopeToBorder = 72.0;  // Width of the slope inside the level border [m].
// Height difference by which the border lies below the lowest road [m].
constexpr double kBorderDepth = 1.0;

/// Stretch of a road along the route.
struct Stretch {
  double from = 0.0;
  double to = 0.0;
  double before = 0.0;  // Length of the straight extension before the stretch [m].
  double after = 0.0;
};

/// Maps each road id to the stretches of this road, which are sorted and disjoint.
using Stretches = std::map<std::string, std::vector<Stretch>>;

Stretches NeededStretches(const RoadNetwork& network, const std::vector<LaneStretch>& route) {
  Stretches all;
  for (std::size_t i = 0; i < route.size(); ++i) {
    const LaneStretch& own = route[i];
    const double length = network.roads.find(own.road)->second.length;
    const bool backward = own.to < own.from;
    const double enters = i == 0 ? kStraightExtension : 0.0;
    const double leaves = i + 1 == route.size() ? kStraightExtension : 0.0;
    all[own.road].push_back({std::max(0.0, std::min(own.from, own.to) - kRoadExtension),
                             std::min(length, std::max(own.from, own.to) + kRoadExtension),
                             backward ? leaves : enters, backward ? enters : leaves});
  }
  for (auto& [id, stretches] : all) {
    std::sort(stretches.begin(), stretches.end(),
              [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
    std::vector<Stretch> merged;
    for (const Stretch& next : stretches) {
      if (merged.empty() || next.from > merged.back().to) {
        merged.push_back(next);
        continue;
      }
      Stretch& last = merged.back();
      last.before = next.from == last.from ? std::max(last.before, next.before) : last.before;
      if (next.to >= last.to) {
        last.after = next.to == last.to ? std::max(last.after, next.after) : next.after;
        last.to = next.to;
      }
    }
    stretches = std::move(merged);
  }
  return all;
}

/// A place at which a lane lies above another lane.
struct Crossing {
  std::string road;
  double s = 0.0;
  std::string other;
  double other_s = 0.0;
  Vec2 place{0.0, 0.0};
  double apart = 0.0;  // Height difference between the lanes [m].
};

/// Combined road surface of all strips along the route.
class Surfaces {
 public:
  explicit Surfaces(std::vector<RoadStrip> strips) : strips_(std::move(strips)) {}

  [[nodiscard]] const std::vector<RoadStrip>& strips() const { return strips_; }

  /// Returns the strips that affect the ground within a circle.
  [[nodiscard]] std::vector<const RoadStrip*> Near(const Vec2& middle, double radius) const {
    std::vector<const RoadStrip*> near;
    for (const RoadStrip& strip : strips_) {
      if ((strip.middle() - middle).norm() < strip.radius() + radius + kInfluenceDistance) {
        near.push_back(&strip);
      }
    }
    return near;
  }

  struct Blend {
    double z = 0.0;
    // Weight of the height z when it is mixed with the coarse terrain: 1 on the lanes, falling to 0
    // beside the lanes.
    double share = 0.0;
  };

  /// Returns the mean height of the strips, weighted by proximity to `point`. If the point is on a
  /// lane, the result is the height of the lane.
  Blend At(const std::vector<const RoadStrip*>& near, const Vec2& point) {
    Blend blend;
    double sum = 0.0;
    const RoadStrip* on = nullptr;
    RoadStrip::Place there;
    for (const RoadStrip* strip : near) {
      const double circle = strip->radius() + kInfluenceDistance;
      if ((strip->middle() - point).squaredNorm() > circle * circle) {
        continue;
      }
      const std::optional<RoadStrip::Place> place = strip->Locate(point);
      if (!place) {
        continue;
      }
      const double away = std::hypot(place->beside, place->beyond - place->straight_on);
      blend.share =
          std::max(blend.share, place->share * Fade((away - kLaneSurfaceMargin) / kBlendWidth));
      const double square = place->beside * place->beside + place->beyond * place->beyond;
      constexpr double kMinSquaredDistance = 1e-6;  // [m^2]
      const double weight =
          place->share / ((square + kMinSquaredDistance) * (square + kMinSquaredDistance));
      sum += weight;
      blend.z += weight * place->z;
      // Ignore the ends of strips: a small step in height between adjacent strips is not a crossing
      // of lanes.
      if (square == 0.0 && place->s > strip->from() && place->s < strip->to()) {
        if (on != nullptr) {
          Compare(*on, there, *strip, *place, point);
        }
        on = strip;
        there = *place;
      }
    }
    blend.z = sum > 0.0 ? blend.z / sum : 0.0;
    return blend;
  }

  /// Returns the place with the largest height difference between two lanes. Returns nullopt if all
  /// height differences are at most 0.1 m, which may be inaccuracies of the map.
  [[nodiscard]] const std::optional<Crossing>& crossing() const { return crossing_; }

 private:
  /// Returns a function that falls from 1 at u = 0 to 0 at u = 1, with zero first and second
  /// derivative at both ends.
  static double Fade(double u) {
    const double v = 1.0 - std::clamp(u, 0.0, 1.0);
    return v * v * v * (10.0 - v * (15.0 - 6.0 * v));
  }

  void Compare(const RoadStrip& one, const RoadStrip::Place& a, const RoadStrip& other,
               const RoadStrip::Place& b, const Vec2& point) {
    constexpr double kMaxHeightDifference = 0.1;  // [m]
    const double apart = std::abs(a.z - b.z);
    if (apart > std::max(kMaxHeightDifference, crossing_ ? crossing_->apart : 0.0)) {
      crossing_ = Crossing{one.road().id, a.s, other.road().id, b.s, point, apart};
    }
  }

  std::vector<RoadStrip> strips_;
  std::optional<Crossing> crossing_;
};

/// Returns points on the lanes of a strip, in rows across the strip that are at most 2 m apart.
std::vector<RoadPosition> PointsOn(const RoadStrip& strip) {
  constexpr double kSpacing = 2.0;  // [m]
  std::vector<RoadPosition> points;
  const double parts = std::ceil((strip.to() - strip.from()) / kSpacing);
  for (double i = 0.0; i <= parts; i += 1.0) {
    const double s = std::lerp(strip.from(), strip.to(), i / parts);
    const auto [right, left] = strip.Borders(s);
    for (const double t : {right, 0.5 * (right + left), left}) {
      points.push_back(PositionAt(strip.road(), s, t));
    }
  }
  return points;
}

/// Returns the weight of a terrain height: 0 at the border of the terrain, 1 well inside the
/// terrain.
double ShareInside(const Terrain::Size& size, int column, int row) {
  const int cells =
      std::min({column, row, size.CoarseColumns() - 1 - column, size.CoarseRows() - 1 - row});
  const double u =
      std::clamp((Terrain::kCoarseCell * cells - kLevelBorder) / kSlopeToBorder, 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

/// Makes the coarse terrain, before blocks are refined. Returns nullopt if the coarse terrain would
/// be too large.
std::optional<Terrain> CoarseTerrain(const std::vector<RoadStrip>& strips) {
  std::vector<RoadPosition> points;
  for (const RoadStrip& strip : strips) {
    const std::vector<RoadPosition> own = PointsOn(strip);
    points.insert(points.end(), own.begin(), own.end());
  }
  Vec2 low(points.front().x, points.front().y);
  Vec2 high = low;
  double lowest = points.front().z;
  for (const RoadPosition& point : points) {
    low = low.cwiseMin(Vec2(point.x, point.y));
    high = high.cwiseMax(Vec2(point.x, point.y));
    lowest = std::min(lowest, point.z);
  }
  constexpr double kMaxSide = 8000.0;  // [m]
  if ((high - low).maxCoeff() > kMaxSide) {
    return std::nullopt;
  }
  Terrain::Size size;
  size.low = Terrain::kBlock * ((low.array() - kMargin) / Terrain::kBlock).floor();
  size.columns = static_cast<int>(std::ceil((high.x() + kMargin - size.low.x()) / Terrain::kBlock));
  size.rows = static_cast<int>(std::ceil((high.y() + kMargin - size.low.y()) / Terrain::kBlock));
  size.base = lowest - kBorderDepth;
  HeightGrid known{size.CoarseColumns(), size.CoarseRows(), {}};
  const auto count = static_cast<std::size_t>(known.columns) * static_cast<std::size_t>(known.rows);
  std::vector<std::pair<double, double>> sums(count);
  for (const RoadPosition& point : points) {
    const Vec2 cell = (Vec2(point.x, point.y) - size.low) / Terrain::kCoarseCell;
    auto& [sum, weight] = sums[static_cast<std::size_t>(std::lround(cell.y())) *
                                   static_cast<std::size_t>(known.columns) +
                               static_cast<std::size_t>(std::lround(cell.x()))];
    sum += point.z;
    weight += 1.0;
  }
  for (const auto& [sum, weight] : sums) {
    known.heights.push_back(weight > 0.0 ? std::optional(sum / weight) : std::nullopt);
  }
  std::vector<double> heights = FillHeights(known);
  for (int row = 0; row < known.rows; ++row) {
    for (int column = 0; column < known.columns; ++column) {
      double& height =
          heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(known.columns) +
                  static_cast<std::size_t>(column)];
      height = std::lerp(size.base, height, ShareInside(size, column, row));
    }
  }
  return Terrain(size, std::move(heights));
}

void RefineAlong(Surfaces& surfaces, Terrain& terrain) {
  const Terrain::Size size = terrain.size();
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      const Vec2 middle = size.low + Terrain::kBlock * Vec2(column + 0.5, row + 0.5);
      // Radius of a circle that contains a block and a small margin [m].
      constexpr double kRadius = 0.75 * Terrain::kBlock;
      const std::vector<const RoadStrip*> near = surfaces.Near(middle, kRadius);
      if (near.empty()) {
        continue;
      }
      terrain.Refine(column, row, [&](const Vec2& point, double coarse) {
        const Surfaces::Blend blend = surfaces.At(near, point);
        return blend.share * (blend.z - coarse);
      });
    }
  }
}

/// Height difference between the ground and a lane of the route at a place.
struct Deviation {
  std::string road;
  double s = 0.0;
  Vec2 place{0.0, 0.0};
  double distance = 0.0;  // [m]
};

Deviation LargestDeviation(const RoadNetwork& network, const std::vector<LaneStretch>& route,
                           const Terrain& terrain) {
  Deviation largest;
  for (const LaneStretch& stretch : route) {
    const Road& road = network.roads.find(stretch.road)->second;
    const double from = std::min(stretch.from, stretch.to);
    const double to = std::max(stretch.from, stretch.to);
    const std::size_t section = road.SectionAt(0.5 * (from + to));
    // Spacing of the checks [m], chosen different from the spacing of the interpolated points.
    constexpr double kSpacing = 0.15;
    const double parts = std::max(1.0, std::ceil((to - from) / kSpacing));
    for (double i = 0.0; i <= parts; i += 1.0) {
      const double s = std::lerp(from, to, i / parts);
      // At the end of a stretch, evaluate the road just before the end, because the next piece of
      // the road may begin there.
      const double piece_of = s < to ? s : std::nextafter(to, from);
      for (const int lane : {stretch.lane, stretch.to_lane}) {
        const LaneBorders borders = LaneBordersAt(road, section, lane, s, piece_of);
        for (const double t : {borders.inner.value, borders.Center().value, borders.outer.value}) {
          const RoadPosition at = PositionAt(road, piece_of, t);
          const double distance = std::abs(terrain.At({at.x, at.y}).height - at.z);
          if (!(distance <= largest.distance)) {
            largest = {road.id, s, {at.x, at.y}, distance};
          }
        }
      }
    }
  }
  return largest;
}

/// Returns whether all roads of a route are level and have the same height.
bool IsLevelRoute(const RoadNetwork& network, const std::vector<LaneStretch>& route) {
  const auto height = [&](const LaneStretch& stretch) {
    return network.roads.find(stretch.road)->second.elevation.At(0.0).value;
  };
  return std::all_of(route.begin(), route.end(), [&](const LaneStretch& stretch) {
    return IsLevel(network.roads.find(stretch.road)->second) &&
           height(stretch) == height(route.front());
  });
}

/// Returns an error message if no ground can be made from the roads; otherwise an empty text.
std::string GroundError(const RoadNetwork& network, const Stretches& needed) {
  double length = 0.0;
  for (const auto& [id, stretches] : needed) {
    const Road& road = network.roads.find(id)->second;
    if (!road.unread_heights.empty()) {
      return fmt::format("road {} has heights that are not read: {}; its surface is not known", id,
                         fmt::join(road.unread_heights, ", "));
    }
    for (const Stretch& stretch : stretches) {
      length += stretch.to - stretch.from;
      for (double s = stretch.from; s <= stretch.to; s += 1.0) {
        if (std::string why = SurfaceError(road, s); !why.empty()) {
          return why;
        }
      }
    }
  }
  constexpr double kMaxLength = 20000.0;  // [m]
  return length > kMaxLength ? fmt::format(
                                   "the route has {:.3g} km of road that is not level; must "
                                   "be at most {:.3g} km",
                                   1e-3 * length, 1e-3 * kMaxLength)
                             : "";
}

RouteGround GroundOf(const RoadNetwork& network, const std::vector<LaneStretch>& stretches) {
  RouteGround ground;
  if (stretches.empty() || IsLevelRoute(network, stretches)) {
    return ground;
  }
  const Stretches needed = NeededStretches(network, stretches);
  ground.failure = GroundError(network, needed);
  if (!ground.ok()) {
    return ground;
  }
  std::vector<RoadStrip> strips;
  for (const auto& [id, own] : needed) {
    for (const Stretch& stretch : own) {
      const std::vector<RoadStrip> more = CutIntoStrips(
          network.roads.find(id)->second, stretch.from, stretch.to, stretch.before, stretch.after);
      strips.insert(strips.end(), more.begin(), more.end());
    }
  }
  TRACKBED_CHECK(!strips.empty(), "a route over no lanes");
  std::optional<Terrain> terrain = CoarseTerrain(strips);
  if (!terrain) {
    ground.failure = "the route is more than 8 km wide or high; too much for roads not level";
    return ground;
  }
  Surfaces surfaces(std::move(strips));
  RefineAlong(surfaces, *terrain);
  if (const std::optional<Crossing>& crossing = surfaces.crossing()) {
    ground.failure = fmt::format(
        "road {} at s = {:.4g} m and road {} at s = {:.4g} m are {:.3g} m above each other at x = "
        "{:.4g} m, y = {:.4g} m; a route must not pass over or under itself",
        crossing->road, crossing->s, crossing->other, crossing->other_s, crossing->apart,
        crossing->place.x(), crossing->place.y());
    return ground;
  }
  const Deviation deviation = LargestDeviation(network, stretches, *terrain);
  constexpr double kMaxDeviation = 0.01;  // [m]
  if (!(deviation.distance <= kMaxDeviation)) {
    ground.failure = fmt::format(
        "the surface of road {} has a step or a kink at s = {:.4g} m, x = {:.4g} m, y = {:.4g} m: "
        "smooth ground is {:.3g} m away from it; must be at most {} m: choose a route around this "
        "place, or correct the elevation in the file there",
        deviation.road, deviation.s, deviation.place.x(), deviation.place.y(), deviation.distance,
        kMaxDeviation);
    return ground;
  }
  ground.deviation = deviation.distance;
  ground.terrain = std::make_shared<const Terrain>(std::move(*terrain));
  return ground;
}

}  // namespace

RouteGround MakeRouteGround(const RoadNetwork& network, const std::vector<LanePlace>& places) {
  const LaneRoute route = FindLaneRoute(network, places);
  return route.ok() ? GroundOf(network, route.stretches) : RouteGround{};
}

}  // namespace trackbed
