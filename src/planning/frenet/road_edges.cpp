#include "trackbed/planning/frenet/road_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// A point on a side of the footprint, in the Frenet frame of the path.
struct SidePoint {
  double s = 0.0;  // [m]
  double d = 0.0;  // [m]
};

constexpr int kPointsPerSide = 5;  // number of points on each long side of the footprint
using SidePoints = std::array<SidePoint, 2 * kPointsPerSide>;

/// Returns points on both long sides of the footprint. Returns nullopt if a point of the footprint
/// lies at or beyond the path's center of curvature.
std::optional<SidePoints> SidesOf(const VehicleParams& car, const PathPoint& at,
                                  const FrenetState& frenet) {
  const double k = at.curvature;
  const double tangent = frenet.d_slope / (1.0 - k * frenet.d);
  const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
  const double sine = tangent * cosine;
  SidePoints points;
  for (int i = 0; i < 2 * kPointsPerSide; ++i) {
    const int from_rear = i / 2;
    const double x = car.length * from_rear / (kPointsPerSide - 1) - car.rear_overhang;
    const double y = i % 2 == 0 ? 0.5 * car.width : -0.5 * car.width;
    const double ahead = x * cosine - y * sine;
    const double aside = frenet.d + x * sine + y * cosine;
    const double to_center = 1.0 - k * aside;
    if (to_center <= 0.0) {
      return std::nullopt;
    }
    // On a path of curvature k, the point (ahead, aside) relative to the rear axle has the offset d
    // = (1 - sqrt((k ahead)^2 + (1 - k aside)^2))/k. Relative to the rear axle, the point (ahead,
    // aside) has the station s = atan(k ahead/(1 - k aside))/k. The code evaluates the equations
    // for d and s in forms that also hold for k = 0.
    const double turned = k * ahead / to_center;
    constexpr double kSmall = 1e-6;
    const double along = std::abs(turned) < kSmall ? ahead / to_center : std::atan(turned) / k;
    points[static_cast<std::size_t>(i)] = {
        frenet.s + along, (2.0 * aside - k * (aside * aside + ahead * ahead)) /
                              (1.0 + std::sqrt(k * ahead * k * ahead + to_center * to_center))};
  }
  return points;
}

/// Lateral offset at which a pose's lateral axis crosses a track edge, and the direction of the
/// edge at the crossing.
struct EdgeAbeam {
  double offset = 0.0;  // Offset of the edge, positive to the left [m].
  double cosine = 1.0;  // Cosine of the angle between the edge and the pose's heading.
};

/// Finds where the lateral axis of a pose crosses a track edge, near the fraction `share` of the
/// lap. If the axis crosses the edge several times, returns the crossing closest to the offset
/// `expected`. If the axis does not cross the edge, returns `expected`.
EdgeAbeam FindAbeam(const TrackEdgeLine& edge, const Pose2& pose, double share, double expected) {
  constexpr double kSearchDistance = 20.0;  // [m]
  const auto count = static_cast<std::ptrdiff_t>(edge.size());
  const auto middle = static_cast<std::ptrdiff_t>(share * static_cast<double>(count));
  const auto reach =
      std::min(static_cast<std::ptrdiff_t>(kSearchDistance / Track::kEdgeSpacing), count / 4);
  const Vec2 forward = Direction(pose.yaw);
  const Vec2 left = LeftNormal(forward);
  EdgeAbeam found{.offset = expected};
  double nearest = std::numeric_limits<double>::infinity();
  for (std::ptrdiff_t k = middle - reach; k <= middle + reach; ++k) {
    const Vec2 a = edge[static_cast<std::size_t>((k % count + count) % count)] - pose.position();
    const Vec2 b =
        edge[static_cast<std::size_t>(((k + 1) % count + count) % count)] - pose.position();
    const double from = a.dot(forward);
    const double to = b.dot(forward);
    if ((from > 0.0) == (to > 0.0)) {
      continue;
    }
    const double offset = std::lerp(a.dot(left), b.dot(left), from / (from - to));
    if (std::abs(offset - expected) < nearest) {
      nearest = std::abs(offset - expected);
      found = {offset, std::abs(to - from) / std::max((b - a).norm(), 1e-9)};
    }
  }
  return found;
}

/// Widens the road edges so that they contain the footprint of a car on the path.
void WidenToFootprint(const Path& path, const VehicleParams& car, double spacing,
                      std::vector<RoadWidths>& widths) {
  constexpr double kSampleSpacing = 0.2;  // Distance between samples of the path [m].
  // Allowance for the motion of the footprint between samples [m].
  constexpr double kSampleTolerance = 2e-3;
  const auto last = static_cast<double>(widths.size() - 1);
  const double count = std::ceil(path.length() / kSampleSpacing);
  for (double i = 0.0; i <= count; i += 1.0) {
    const PathPoint at = path.At(path.length() * i / std::max(count, 1.0));
    const auto sides = SidesOf(car, at, {.s = at.s});
    for (const SidePoint& point : sides.value_or(SidePoints{})) {
      const double place = std::clamp(point.s / spacing, 0.0, last);
      for (const double node : {std::floor(place), std::ceil(place)}) {
        RoadWidths& there = widths[static_cast<std::size_t>(node)];
        there.left = std::max(there.left, point.d + kSampleTolerance);
        there.right = std::max(there.right, kSampleTolerance - point.d);
      }
    }
  }
}

}  // namespace

RoadEdges::RoadEdges(double spacing, std::vector<RoadWidths> widths)
    : spacing_(spacing), widths_(std::move(widths)) {
  TRACKBED_CHECK(spacing_ > 0.0 && !widths_.empty(), "{} widths, {} m apart", widths_.size(),
                 spacing_);
}

RoadWidths RoadEdges::At(double s) const {
  const double place = std::clamp(s / spacing_, 0.0, static_cast<double>(widths_.size() - 1));
  const auto before = static_cast<std::size_t>(place);
  const RoadWidths& a = widths_[before];
  const RoadWidths& b = widths_[std::min(before + 1, widths_.size() - 1)];
  const double share = place - std::floor(place);
  return {std::lerp(a.left, b.left, share), std::lerp(a.right, b.right, share)};
}

double ReachBeyond(const RoadEdges& edges, const VehicleParams& vehicle, const PathPoint& at,
                   const FrenetState& frenet) {
  const auto sides = SidesOf(vehicle, at, frenet);
  if (!sides) {
    return std::numeric_limits<double>::infinity();
  }
  double beyond = -std::numeric_limits<double>::infinity();
  for (const SidePoint& point : *sides) {
    const RoadWidths there = edges.At(point.s);
    beyond = std::max({beyond, point.d - there.left, -point.d - there.right});
  }
  return beyond;
}

RoadEdges EdgesBeside(const Path& path, const Track& track, const VehicleParams& vehicle,
                      double distance) {
  constexpr double kSpacing = 0.5;  // [m]
  const double count = std::max(std::ceil(path.length() / kSpacing), 1.0);
  const double spacing = std::max(path.length() / count, 1e-3);
  std::vector<RoadWidths> widths;
  std::optional<double> station;
  for (double i = 0.0; i <= count; i += 1.0) {
    const Pose2 pose = path.At(i * spacing).pose;
    const TrackPlace place = track.Locate(pose.position(), station);
    station = place.s;
    const TrackEdges edges = track.EdgesAt(place.s);
    const double share = place.s / track.length();
    const EdgeAbeam left = FindAbeam(track.left_edge(), pose, share, edges.left - place.offset);
    const EdgeAbeam right = FindAbeam(track.right_edge(), pose, share, edges.right - place.offset);
    // The distance required from the edge is perpendicular to the edge; the distance along the
    // lateral axis of the pose is therefore larger.
    widths.push_back({.left = left.offset - distance / std::max(left.cosine, 0.5),
                      .right = -right.offset - distance / std::max(right.cosine, 0.5)});
  }
  WidenToFootprint(path, vehicle, spacing, widths);
  return {spacing, std::move(widths)};
}

}  // namespace trackbed
