#include "trackbed/road_network/road_network.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Tolerance for comparing stations, because stations in files have rounding errors [m].
constexpr double kStationSlack = 1e-3;

double OnRoad(const Road& road, double s) {
  TRACKBED_REQUIRE(s >= -kStationSlack && s <= road.length + kStationSlack,
                   "road {}: station {} m; must be between 0 and {} m", road.id, s, road.length);
  return std::clamp(s, 0.0, road.length);
}

bool HasSlope(const PiecewiseCubic& function) {
  return std::any_of(function.pieces().begin(), function.pieces().end(), [](const auto& piece) {
    const auto& c = piece.coefficients;
    return c[1] != 0.0 || c[2] != 0.0 || c[3] != 0.0;
  });
}

/// Returns whether a piecewise constant function, such as the elevation of a road without slopes,
/// has steps.
bool HasSteps(const PiecewiseCubic& function) {
  const auto& pieces = function.pieces();
  return std::any_of(pieces.begin(), pieces.end(), [&](const auto& piece) {
    return piece.coefficients[0] != pieces.front().coefficients[0];
  });
}

CubicValue Sum(const CubicValue& a, const CubicValue& b, double factor) {
  return {a.value + factor * b.value, a.slope + factor * b.slope, a.second + factor * b.second};
}

}  // namespace

const Lane* LaneSection::Find(int lane) const {
  const std::int64_t index = lanes.empty() ? -1 : std::int64_t{lanes.front().id} - lane;
  return index >= 0 && index < static_cast<std::int64_t>(lanes.size())
             ? &lanes[static_cast<std::size_t>(index)]
             : nullptr;
}

std::size_t Road::SectionAt(double s) const {
  const auto after =
      std::upper_bound(sections.begin(), sections.end(), s,
                       [](double at, const LaneSection& section) { return at < section.s; });
  return after == sections.begin() ? 0 : static_cast<std::size_t>(after - sections.begin()) - 1;
}

double Road::SectionEnd(std::size_t section) const {
  return section + 1 < sections.size() ? sections[section + 1].s : length;
}

CubicValue LaneBorders::Center() const {
  return {0.5 * (inner.value + outer.value), 0.5 * (inner.slope + outer.slope),
          0.5 * (inner.second + outer.second)};
}

double LaneBorders::Width() const {
  return std::abs(outer.value - inner.value);
}

LaneBorders LaneBordersAt(const Road& road, std::size_t section, int lane, double s,
                          double piece_of) {
  TRACKBED_REQUIRE(section < road.sections.size() && road.sections[section].Find(lane) != nullptr,
                   "road {}: no lane {} in section {}", road.id, lane, section);
  const LaneSection& own = road.sections[section];
  const CubicValue center = road.lane_offset.At(s, piece_of);
  LaneBorders borders{center, center};
  const int side = lane > 0 ? 1 : -1;
  for (int id = side; id * side <= lane * side; id += side) {
    const Lane& next = *own.Find(id);
    const CubicValue extent = next.extent.At(s - own.s, piece_of - own.s);
    borders.inner = borders.outer;
    borders.outer = next.has_border ? extent : Sum(borders.outer, extent, side);
  }
  return borders;
}

LaneBorders LaneBordersAt(const Road& road, int lane, double s) {
  const double at = OnRoad(road, s);
  return LaneBordersAt(road, road.SectionAt(at), lane, at, at);
}

Eigen::Vector3d AcrossSurface(const Vec2& tangent, double slope, double roll) {
  const Vec2 left = LeftNormal(tangent.normalized());
  const Eigen::Vector3d ahead = Eigen::Vector3d(tangent.x(), tangent.y(), slope).normalized();
  const Eigen::Vector3d level(left.x(), left.y(), 0.0);
  return std::cos(roll) * level + std::sin(roll) * ahead.cross(level);
}

RoadPosition PositionAt(const Road& road, double s, double t) {
  const double at = OnRoad(road, s);
  TRACKBED_REQUIRE(std::isfinite(t), "road {}: t is {}; must be finite", road.id, t);
  const ReferenceLinePoint reference = road.reference.At(at);
  const CubicValue height = road.elevation.At(at);
  const double roll = road.superelevation.At(at).value;
  const Eigen::Vector3d across =
      AcrossSurface(reference.stretch * Direction(reference.pose.yaw), height.slope, roll);
  return {reference.pose.x + t * across.x(), reference.pose.y + t * across.y(),
          height.value + t * across.z() + ShapeHeight(road, at, t), reference.pose.yaw};
}

double ShapeHeight(const Road& road, double s, double t) {
  if (road.shape.empty()) {
    return 0.0;
  }
  const auto height = [&](const ShapeProfile& profile) {
    return profile.height.At(t, std::max(t, profile.height.pieces().front().s)).value;
  };
  const auto after =
      std::upper_bound(road.shape.begin(), road.shape.end(), s,
                       [](double at, const ShapeProfile& profile) { return at < profile.s; });
  if (after == road.shape.begin() || after == road.shape.end()) {
    return height(after == road.shape.begin() ? road.shape.front() : road.shape.back());
  }
  const ShapeProfile& before = *(after - 1);
  return std::lerp(height(before), height(*after), (s - before.s) / (after->s - before.s));
}

namespace {

/// The product of two functions, with its derivatives.
CubicValue Product(const CubicValue& a, const CubicValue& b) {
  return {a.value * b.value, a.slope * b.value + a.value * b.slope,
          a.second * b.value + 2.0 * a.slope * b.slope + a.value * b.second};
}

/// The sine of the angle at which a road's reference line climbs, with derivatives. `stretch` is
/// the ratio of arc length to station.
CubicValue SineOfSlope(const Road& road, double stretch, double s, double piece_of) {
  const CubicValue height = road.elevation.At(s, piece_of);
  // The second derivative of a cubic polynomial is linear, so the difference quotient is exact.
  const double third = road.elevation.At(s + 1.0, piece_of).second - height.second;
  const double square = stretch * stretch + height.slope * height.slope;
  const double root = std::sqrt(square);
  const double change = stretch * stretch / (square * root);
  return {height.slope / root, height.second * change,
          third * change - 3.0 * height.slope * height.second * height.second * change / square};
}

}  // namespace

// The line on the road surface is P(s) = R + n N + a T, where R is the reference line with the
// tangent T, the left normal N and the curvature k. With the lateral coordinate t, the roll angle r
// and the climbing angle c of the reference line, n = t cos(r) and a = -t sin(r) sin(c). The
// derivative of the surface line P(s) is A T + B N, where A = q (1 - k n) + a', B = n' + q k a and
// q = |dR/ds|.
SurfaceLine SurfaceLineAt(const Road& road, const CubicValue& t, double s, double piece_of) {
  const ReferenceLinePoint reference = road.reference.At(s, piece_of);
  const CubicValue roll = road.superelevation.At(s, piece_of);
  const double sine = std::sin(roll.value);
  const double cosine = std::cos(roll.value);
  const double q = reference.stretch;
  const double k = reference.curvature;
  const double k_slope = q * reference.sharpness;
  const CubicValue n = Product(
      t, {cosine, -sine * roll.slope, -sine * roll.second - cosine * roll.slope * roll.slope});
  CubicValue a;
  if (sine != 0.0 || roll.slope != 0.0 || roll.second != 0.0) {
    a = Product(Product(t, {-sine, -cosine * roll.slope,
                            -cosine * roll.second + sine * roll.slope * roll.slope}),
                SineOfSlope(road, q, s, piece_of));
  }
  const double ahead = q * (1.0 - k * n.value) + a.slope;
  const double left = n.slope + q * k * a.value;
  const double ahead_slope = -q * (k_slope * n.value + k * n.slope) + a.second;
  const double left_slope = n.second + q * (k_slope * a.value + k * a.slope);
  SurfaceLine line;
  line.position = ToWorld(reference.pose, {a.value, n.value});
  line.speed = std::hypot(ahead, left);
  line.folded = ahead <= 0.0;
  line.heading = reference.pose.yaw + std::atan2(left, ahead);
  line.curvature =
      (q * k + (left_slope * ahead - left * ahead_slope) / (line.speed * line.speed)) / line.speed;
  return line;
}

RoadPosition LanePositionAt(const Road& road, int lane, double s, double offset) {
  return PositionAt(road, s, LaneBordersAt(road, lane, s).Center().value + offset);
}

bool IsLevel(const Road& road) {
  const auto& roll = road.superelevation.pieces();
  return !HasSlope(road.elevation) && !HasSteps(road.elevation) && !HasSlope(road.superelevation) &&
         std::all_of(roll.begin(), roll.end(),
                     [](const auto& piece) { return piece.coefficients[0] == 0.0; }) &&
         road.shape.empty() && road.unread_heights.empty();
}

bool IsDrivable(const Lane& lane) {
  static constexpr std::array<std::string_view, 13> kTypes{
      "driving",       "entry", "exit", "onRamp", "offRamp",  "connectingRamp", "slipLane",
      "bidirectional", "bus",   "taxi", "HOV",    "mwyEntry", "mwyExit"};
  return std::find(kTypes.begin(), kTypes.end(), lane.type) != kTypes.end();
}

std::pair<int, int> OutermostLanes(const LaneSection& section) {
  std::pair<int, int> found{0, 0};
  for (const Lane& lane : section.lanes) {  // the lanes are ordered from left to right
    if (lane.id != 0 && IsDrivable(lane)) {
      found = {found.first == 0 ? lane.id : found.first, lane.id};
    }
  }
  return found;
}

bool FollowsRoad(const Road& road, int lane) {
  return (lane < 0) != road.left_hand_traffic;
}

}  // namespace trackbed
