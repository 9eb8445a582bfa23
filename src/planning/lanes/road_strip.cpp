#include "src/planning/lanes/road_strip.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr double kNodeSpacing = 1.0;  // [m]

/// Returns the smooth step function, which rises from 0 at u = 0 to 1 at u = 1.
double SmoothStep(double u) {
  const double v = std::clamp(u, 0.0, 1.0);
  return v * v * (3.0 - 2.0 * v);
}

/// Returns whether a piece of a road is short enough and straight enough to form one strip.
bool IsShort(const Road& road, double from, double to) {
  constexpr double kMaxLength = 16.0;  // [m]
  constexpr double kMaxTurn = 0.5;     // [rad]
  constexpr double kMinLength = 0.5;   // [m]
  if (to - from > kMaxLength) {
    return false;
  }
  double most = 0.0;
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    most = std::max(
        most,
        std::abs(road.reference.At(std::lerp(from, to, part), std::lerp(from, to, 0.5)).curvature));
  }
  return most * (to - from) < kMaxTurn || to - from < kMinLength;
}

/// Returns the height of a road's profile. Beside the lanes, which are between the lateral
/// coordinates `right` and `left`, the profile continues straight for 2 m, and then level: the
/// file's polynomials may end at the lanes.
double ShapeBeside(const Road& road, double s, double t, double right, double left) {
  if (road.shape.empty()) {
    return 0.0;
  }
  constexpr double kStraight = 2.0;  // Width of the straight profile beside the lanes [m].
  constexpr double kStep = 1e-3;     // Step of the difference quotient at the border [m].
  const double border = std::clamp(t, right, left);
  const double height = ShapeHeight(road, s, border);
  const double beside = std::clamp(t - border, -kStraight, kStraight);
  if (beside == 0.0) {
    return height;
  }
  const double inside = border - std::copysign(std::min(kStep, left - right), beside);
  return inside == border
             ? height
             : height + beside * (height - ShapeHeight(road, s, inside)) / (border - inside);
}

void Cut(const Road& road, double from, double to, double before, double after,
         std::vector<RoadStrip>& strips) {
  if (IsShort(road, from, to)) {
    strips.emplace_back(road, from, to, before, after);
    return;
  }
  const double middle = 0.5 * (from + to);
  Cut(road, from, middle, before, 0.0, strips);
  Cut(road, middle, to, 0.0, after, strips);
}

}  // namespace

RoadStrip::RoadStrip(const Road& road, double from, double to, double before, double after)
    : road_(&road),
      section_(road.SectionAt(0.5 * (from + to))),
      from_(from),
      to_(to),
      before_(before),
      after_(after) {
  TRACKBED_CHECK(from < to, "a strip from {} to {} m", from, to);
  std::tie(leftmost_, rightmost_) = OutermostLanes(road.sections[section_]);
  const auto parts = static_cast<std::size_t>(std::max(1.0, std::ceil((to - from) / kNodeSpacing)));
  const double inside = 0.5 * (from + to);
  for (std::size_t i = 0; i <= parts; ++i) {
    const double s = std::lerp(from, to, static_cast<double>(i) / static_cast<double>(parts));
    const ReferenceLinePoint at = road.reference.At(s, inside);
    nodes_.push_back({at.pose.position(), at.stretch * Direction(at.pose.yaw)});
    curvature_ += at.curvature / static_cast<double>(parts + 1);
  }
  middle_ = ReferenceAt(inside).position;
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double s = std::lerp(from, to, part);
    const auto [right, left] = Borders(s);
    radius_ = std::max(radius_, (ReferenceAt(s).position - middle_).norm() +
                                    std::max(std::abs(left), std::abs(right)));
  }
  radius_ += std::max(before, after);
}

RoadStrip::Node RoadStrip::ReferenceAt(double s) const {
  // Interpolates the reference line cubically between the nodes. On an arc of 5 m radius, the
  // interpolation error is 0.02 mm.
  const double parts = static_cast<double>(nodes_.size() - 1);
  const double place = parts * (s - from_) / (to_ - from_);
  const std::size_t i = std::min(static_cast<std::size_t>(std::max(place, 0.0)), nodes_.size() - 2);
  const double u = place - static_cast<double>(i);
  const double step = (to_ - from_) / parts;
  const Vec2 chord = nodes_[i + 1].position - nodes_[i].position;
  const Vec2 a = step * nodes_[i].tangent;
  const Vec2 b = step * nodes_[i + 1].tangent;
  const Vec2 square = 3.0 * chord - 2.0 * a - b;
  const Vec2 cube = a + b - 2.0 * chord;
  return {nodes_[i].position + u * (a + u * (square + u * cube)),
          (a + u * (2.0 * square + 3.0 * u * cube)) / step};
}

std::pair<double, double> RoadStrip::Borders(double s) const {
  const double piece_of = s < to_ ? s : std::nextafter(to_, from_);
  const auto border = [&](int lane, bool left) {
    const LaneBorders both = LaneBordersAt(*road_, section_, lane, s, piece_of);
    return (lane > 0) == left ? both.outer.value : both.inner.value;
  };
  return {border(rightmost_, false), border(leftmost_, true)};
}

std::optional<RoadStrip::Place> RoadStrip::Locate(const Vec2& point_W) const {
  // Distance from the center of curvature below which no place is found, as a fraction of the
  // radius of curvature.
  constexpr double kFold = 0.1;
  constexpr double kFoldEnd = 0.5;
  double s = 0.5 * (from_ + to_);
  for (int i = 0; i < 20; ++i) {
    const Node reference = ReferenceAt(s);
    const CubicValue height = road_->elevation.At(s);
    const Eigen::Vector3d across =
        AcrossSurface(reference.tangent, height.slope, road_->superelevation.At(s).value);
    const double stretch = reference.tangent.norm();
    const Vec2 ahead = reference.tangent / stretch;
    const Vec2 offset = point_W - reference.position;
    const double level = offset.dot(LeftNormal(ahead));
    const double t = level / across.head<2>().dot(LeftNormal(ahead));
    const double along = ahead.dot(offset - t * across.head<2>());
    const double fold = 1.0 - curvature_ * level;
    const double next = std::clamp(s + along / (stretch * std::max(fold, 0.3)), from_, to_);
    constexpr double kEqualityTolerance = 1e-8;  // [m]
    if (std::abs(next - s) > kEqualityTolerance) {
      s = next;
      continue;
    }
    if (fold < kFold || !std::isfinite(t)) {
      return std::nullopt;
    }
    const double beyond = s == from_ || s == to_ ? std::abs(along) : 0.0;
    const double on = std::min(beyond, along < 0.0 ? before_ : after_);
    constexpr double kLevelingLength = 10.0;  // [m]
    const double run = on + kLevelingLength * (1.0 - std::exp((on - beyond) / kLevelingLength));
    const auto [right, left] = Borders(s);
    return Place{.s = s,
                 .z = height.value + t * across.z() + ShapeBeside(*road_, s, t, right, left) +
                      std::copysign(run, along) * height.slope / stretch,
                 .beside = std::max({0.0, right - t, t - left}),
                 .beyond = beyond,
                 .straight_on = on,
                 .share = SmoothStep((fold - kFold) / (kFoldEnd - kFold))};
  }
  return std::nullopt;
}

std::vector<RoadStrip> CutIntoStrips(const Road& road, double from, double to, double before,
                                     double after) {
  std::vector<double> ends{from, to};
  const auto add = [&](const auto& pieces) {
    for (const auto& piece : pieces) {
      constexpr double kMinSpacing = 1e-6;  // [m]
      if (piece.s > from + kMinSpacing && piece.s < to - kMinSpacing) {
        ends.push_back(piece.s);
      }
    }
  };
  add(road.sections);
  add(road.reference.pieces());
  std::sort(ends.begin(), ends.end());
  std::vector<RoadStrip> strips;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (ends[i] <= ends[i - 1] ||
        OutermostLanes(road.sections[road.SectionAt(0.5 * (ends[i - 1] + ends[i]))]).first == 0) {
      continue;
    }
    Cut(road, ends[i - 1], ends[i], i == 1 ? before : 0.0, i + 1 == ends.size() ? after : 0.0,
        strips);
  }
  return strips;
}

}  // namespace trackbed
