#include "src/road_network/lane_centers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "trackbed/core/angle.h"

// Joins the centers of a route's lanes to a path. The center line of a lane is the reference line
// of the road plus a lateral offset, which is measured across the road's surface and projected to
// the plane. In a lane change, a quintic polynomial blends the offsets of the two lanes. The
// algorithm splits the lane centers into pieces, at the stations where one polynomial of the
// OpenDRIVE file ends and the next polynomial begins. Each piece is sampled at points with exact
// heading and curvature. Kinks of at most 0.2 rad are rounded over 0.5 m on either side, and
// negligible steps of curvature become ramps. The algorithm rejects a route whose lane centers have
// gaps or larger kinks, and a path that deviates too far from the lane centers.

namespace trackbed {
namespace {

// Largest distance between consecutive points of the lane centers, which path segments connect [m].
constexpr double kSpacing = 0.25;
constexpr double kKink = 1e-6;    // Largest kink that is not rounded [rad].
constexpr double kMaxKink = 0.2;  // Largest kink that is rounded [rad].
// Largest step of curvature that is rounded as a kink is [1/m]: rounding moves the line by 1e-3/24
// m, 0.04 mm. Joints of a bank or of a climb on a bank, and rounded numbers in a file, cause such
// steps. A planner would reserve time for turning the wheels at each step.
constexpr double kCurvatureStep = 1e-3;
// Change of the curvature that counts as 0 [1/m]; a curvature of this size turns a line of 100 km
// by 1e-4 rad.
constexpr double kSameCurvature = 1e-9;
// Length of the center line that rounding replaces on either side of a kink [m].
constexpr double kRounding = 0.5;
constexpr double kMaxDeviation = 0.05;  // [m]

/// A point of a lane's center line, with heading and curvature in driving direction.
struct CenterPoint {
  Vec2 position{0.0, 0.0};
  CurvePoint curve;  ///< distance along the center line, heading and curvature at the point
};

/// Points of a piece of a lane's center line without kinks.
using Piece = std::vector<CenterPoint>;

/// A stretch of a route, together with the road and the lane section in which the stretch lies.
struct RoadStretch {
  const Road& road;
  std::size_t section;
  const LaneStretch& stretch;

  [[nodiscard]] int direction() const { return stretch.to > stretch.from ? 1 : -1; }

  /// Returns the lateral offset t of the path from the reference line at station s, and the
  /// derivatives of t with respect to s. The argument `piece_of` is explained at LaneBordersAt.
  [[nodiscard]] CubicValue Offset(double s, double piece_of) const {
    const CubicValue a = LaneBordersAt(road, section, stretch.lane, s, piece_of).Center();
    if (stretch.to_lane == stretch.lane) {
      return a;
    }
    const CubicValue b = LaneBordersAt(road, section, stretch.to_lane, s, piece_of).Center();
    // Blend the offsets with a quintic polynomial w that rises from 0 to 1, with zero slope and
    // curvature at both ends.
    const double scale = 1.0 / (stretch.to - stretch.from);
    const double q = std::clamp((s - stretch.from) * scale, 0.0, 1.0);
    const double w = q * q * q * (10.0 + q * (-15.0 + 6.0 * q));
    const double w1 = 30.0 * q * q * (1.0 - q) * (1.0 - q) * scale;
    const double w2 = 60.0 * q * (1.0 - q) * (1.0 - 2.0 * q) * scale * scale;
    const double gap = b.value - a.value;
    const double gap1 = b.slope - a.slope;
    return {a.value + w * gap, a.slope + w1 * gap + w * gap1,
            a.second + w2 * gap + 2.0 * w1 * gap1 + w * (b.second - a.second)};
  }
};

/// Whether the superelevation moves the lanes sideways.
bool IsBanked(const Road& road) {
  const auto& pieces = road.superelevation.pieces();
  return std::any_of(pieces.begin(), pieces.end(), [](const auto& piece) {
    return piece.coefficients != std::array<double, 4>{};
  });
}

/// Returns the stations at which a polynomial that defines the lane center ends and the next
/// polynomial begins.
std::vector<double> Joints(const RoadStretch& own) {
  const double low = std::min(own.stretch.from, own.stretch.to);
  const double high = std::max(own.stretch.from, own.stretch.to);
  std::vector<double> joints;
  const auto add = [&](double s) { joints.push_back(s); };
  for (const auto& piece : own.road.reference.pieces()) {
    add(piece.s);
  }
  for (const auto& piece : own.road.lane_offset.pieces()) {
    add(piece.s);
  }
  if (IsBanked(own.road)) {
    for (const PiecewiseCubic* function : {&own.road.superelevation, &own.road.elevation}) {
      for (const auto& piece : function->pieces()) {
        add(piece.s);
      }
    }
  }
  const LaneSection& section = own.road.sections[own.section];
  for (const Lane& lane : section.lanes) {
    for (const auto& piece : lane.extent.pieces()) {
      add(section.s + piece.s);
    }
  }
  std::sort(joints.begin(), joints.end());
  std::vector<double> apart{low};
  for (const double joint : joints) {
    if (joint > apart.back() + kMergedJoints && joint < high - kMergedJoints) {
      apart.push_back(joint);
    }
  }
  apart.push_back(high);
  return apart;
}

SurfaceLine StateAt(const RoadStretch& own, double s, double piece_of) {
  return SurfaceLineAt(own.road, own.Offset(s, piece_of), s, piece_of);
}

/// Returns the smooth pieces of a stretch's lane center, in driving direction. Returns no pieces if
/// the lane center is folded (SurfaceLine::folded).
std::vector<Piece> SmoothPieces(const RoadStretch& own) {
  std::vector<Piece> pieces;
  const std::vector<double> joints = Joints(own);
  for (std::size_t i = 1; i < joints.size(); ++i) {
    const double length = joints[i] - joints[i - 1];
    const double middle = 0.5 * (joints[i] + joints[i - 1]);
    const auto count = static_cast<std::size_t>(std::ceil(length / kSpacing));
    const double step = length / static_cast<double>(count);
    Piece piece;
    double distance = 0.0;
    for (std::size_t j = 0; j <= count; ++j) {
      const double s = j == count ? joints[i] : joints[i - 1] + step * static_cast<double>(j);
      if (j > 0) {
        distance += boost::math::quadrature::gauss<double, 7>::integrate(
            [&](double at) { return StateAt(own, at, middle).speed; }, s - step, s);
      }
      const SurfaceLine state = StateAt(own, s, middle);
      if (state.folded) {
        return {};
      }
      piece.push_back({state.position, {distance, state.heading, state.curvature}});
    }
    if (own.direction() < 0) {
      std::reverse(piece.begin(), piece.end());
      for (CenterPoint& point : piece) {
        point.curve = {distance - point.curve.s, point.curve.yaw + kPi, -point.curve.curvature};
      }
    }
    pieces.push_back(std::move(piece));
  }
  if (own.direction() < 0) {
    std::reverse(pieces.begin(), pieces.end());
  }
  return pieces;
}

std::string Place(const Piece& piece) {
  return fmt::format("at x = {:.4g} m, y = {:.4g} m", piece.front().position.x(),
                     piece.front().position.y());
}

/// Joins pieces of lane centers to one line with continuous distances and headings. Kinks between
/// pieces are rounded.
class Joiner {
 public:
  /// Adds a piece to the end of the line. If the piece cannot be joined, Add returns the reason,
  /// otherwise an empty text.
  std::string Add(Piece piece) {
    if (runs_.empty()) {
      runs_.push_back(std::move(piece));
      return "";
    }
    Piece& before = runs_.back();
    const CurvePoint end = before.back().curve;
    const double kink = AngleDifference(piece.front().curve.yaw, end.yaw);
    const double turn = end.yaw + kink - piece.front().curve.yaw;
    const double gap = (piece.front().position - before.back().position).norm();
    for (CenterPoint& point : piece) {
      point.curve.s += end.s;
      point.curve.yaw += turn;
    }
    if (std::abs(kink) > kMaxKink) {
      return fmt::format(
          "the lanes' centers have a kink of {:.3g} rad (at most {}) {}; choose a route around "
          "this "
          "place, or correct the file there",
          kink, kMaxKink, Place(piece));
    }
    if (gap > kMaxDeviation) {
      return fmt::format(
          "the lanes' centers are {:.3g} m apart (at most {} m) {}; choose a route around this "
          "place, or correct the file there",
          gap, kMaxDeviation, Place(piece));
    }
    const double step = std::abs(piece.front().curve.curvature - end.curvature);
    const bool is_rounded_step = step > kSameCurvature && step <= kCurvatureStep;
    if (std::abs(kink) <= kKink && !is_rounded_step) {
      runs_.push_back(std::move(piece));
      return "";
    }
    // Remove the points around the joint that the rounding replaces, but keep the first point of
    // the line and the last point of the new piece.
    while (before.size() > 1 && before.back().curve.s > end.s - kRounding) {
      before.pop_back();
    }
    auto first = piece.begin();
    while (first + 1 != piece.end() && first->curve.s < end.s + kRounding) {
      ++first;
    }
    before.insert(before.end(), first, piece.end());
    return "";
  }

  /// Builds the path. Adjacent pieces of the same straight line or arc become one segment, because
  /// planners use the distances between steps of the curvature.
  [[nodiscard]] Path Join() const {
    std::vector<Segment> segments;
    for (const Piece& run : runs_) {
      std::vector<CurvePoint> points;
      for (const CenterPoint& point : run) {
        points.push_back(point.curve);
      }
      for (Segment& segment : SegmentsThrough(points)) {
        const double change = std::abs(segment.sharpness) * segment.length +
                              std::abs(segment.sharpness_rate) * segment.length * segment.length;
        if (change < kSameCurvature) {
          segment.sharpness = 0.0;
          segment.sharpness_rate = 0.0;
        }
        Segment* before = segments.empty() ? nullptr : &segments.back();
        if (before != nullptr && change < kSameCurvature && before->sharpness == 0.0 &&
            before->sharpness_rate == 0.0 &&
            std::abs(before->curvature - segment.curvature) < kSameCurvature) {
          before->length += segment.length;
        } else {
          segments.push_back(segment);
        }
      }
    }
    const CenterPoint& start = runs_.front().front();
    return Path({start.position.x(), start.position.y(), start.curve.yaw}, std::move(segments));
  }

 private:
  std::vector<Piece> runs_;
};

/// Returns the largest distance between a point of the lane centers and the path's point at the
/// same station [m].
double Deviation(const Path& path, const std::vector<Piece>& pieces) {
  double worst = 0.0;
  double station = 0.0;
  for (const Piece& piece : pieces) {
    for (const CenterPoint& point : piece) {
      const Vec2 at = path.At(std::min(station + point.curve.s, path.length())).pose.position();
      worst = std::max(worst, (at - point.position).norm());
    }
    station += piece.back().curve.s;
  }
  return worst;
}

}  // namespace

JoinedPath JoinLaneCenters(const RoadNetwork& network, const std::vector<LaneStretch>& stretches) {
  JoinedPath joined;
  Joiner joiner;
  std::vector<Piece> all;
  std::size_t points = 0;
  for (const LaneStretch& stretch : stretches) {
    const Road& road = network.roads.find(stretch.road)->second;
    const RoadStretch own{road, road.SectionAt(0.5 * (stretch.from + stretch.to)), stretch};
    const std::vector<Piece> pieces = SmoothPieces(own);
    if (pieces.empty()) {
      joined.failure = fmt::format(
          "road {}: the center of lane {} lies beyond the road's center "
          "of curvature",
          stretch.road, stretch.lane);
      return joined;
    }
    for (const Piece& piece : pieces) {
      if (const std::string why = joiner.Add(piece); !why.empty()) {
        joined.failure = fmt::format("road {}, lane {}: {}", stretch.road, stretch.lane, why);
        return joined;
      }
      all.push_back(piece);
      points += piece.size();
    }
    constexpr std::size_t kMaxPoints = 2000000;
    if (points > kMaxPoints) {
      joined.failure = fmt::format("the lanes' centers have more than {} pieces", kMaxPoints);
      return joined;
    }
  }
  joined.path = joiner.Join();
  joined.deviation = Deviation(joined.path, all);
  if (joined.deviation > kMaxDeviation) {
    joined.failure = fmt::format(
        "gaps and kinks of the lanes' centers take the path {:.3g} m off them (at most "
        "{} m)",
        joined.deviation, kMaxDeviation);
  }
  return joined;
}

}  // namespace trackbed
