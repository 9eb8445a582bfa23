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
          height.value + t * across.z(), reference.pose.yaw};
}

RoadPosition LanePositionAt(const Road& road, int lane, double s, double offset) {
  return PositionAt(road, s, LaneBordersAt(road, lane, s).Center().value + offset);
}

bool IsLevel(const Road& road) {
  const auto& roll = road.superelevation.pieces();
  return !HasSlope(road.elevation) && !HasSteps(road.elevation) && !HasSlope(road.superelevation) &&
         std::all_of(roll.begin(), roll.end(),
                     [](const auto& piece) { return piece.coefficients[0] == 0.0; }) &&
         road.unread_heights.empty();
}

bool IsDrivable(const Lane& lane) {
  static constexpr std::array<std::string_view, 13> kTypes{
      "driving",       "entry", "exit", "onRamp", "offRamp",  "connectingRamp", "slipLane",
      "bidirectional", "bus",   "taxi", "HOV",    "mwyEntry", "mwyExit"};
  return std::find(kTypes.begin(), kTypes.end(), lane.type) != kTypes.end();
}

bool FollowsRoad(const Road& road, int lane) {
  return (lane < 0) != road.left_hand_traffic;
}

}  // namespace trackbed
