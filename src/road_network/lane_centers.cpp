#include "src/road_network/lane_centers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "src/road_network/center_gaps.h"
#include "trackbed/core/angle.h"
#include "trackbed/geometry/pose.h"

// Joins the center lines of a route's lanes to a path. The center line of a lane is the reference
// line of the road plus a lateral offset. The lateral offset of a lane center is measured across
// the road's surface and projected to the horizontal plane. In a lane change, a quintic polynomial
// blends the offsets of the two lanes. The algorithm splits the lane centers into pieces, at the
// stations where one polynomial of the OpenDRIVE file ends and the next polynomial begins. Each
// piece of a lane center is sampled at points with exact heading and curvature. Kinks of at most
// 0.2 rad are rounded over 0.5 m on either side, and negligible steps of curvature become linear
// changes of curvature. The path through the pieces then returns to the lane centers after each gap
// (center_gaps.h). The algorithm rejects a route whose lane centers have larger gaps or kinks, and
// a path that deviates too far from the lane centers.

namespace trackbed {
namespace {

// Largest distance between consecutive points of the lane centers, which path segments connect [m].
constexpr double kSpacing = 0.25;
constexpr double kKink = 1e-6;    // Largest kink of the lane centers that is not rounded [rad].
constexpr double kMaxKink = 0.2;  // Largest kink of the lane centers that is rounded; larger kinks
                                  // are rejected [rad].
// Largest step of curvature that is rounded in the same way as a kink [1/m]. Rounding such a
// curvature step moves the center line by at most 1e-3/24 m, which is 0.04 mm. Curvature steps up
// to 1e-3 1/m are caused by joints of superelevation or elevation polynomials, and by rounded
// numbers in a file. Without rounding, a planner would reserve time for turning the wheels at each
// step of the curvature.
constexpr double kCurvatureStep = 1e-3;
// Largest change of the curvature that counts as 0 [1/m]. Along 100 km, a curvature of 1e-9 1/m
// changes the heading by 1e-4 rad.
constexpr double kSameCurvature = 1e-9;
// Length of the center line that rounding replaces on either side of a kink [m].
constexpr double kRounding = 0.5;
// Length of the longest segment that replaces the center line around kinks [m].
constexpr double kLongestRounding = 2.0 * (kRounding + kSpacing);
constexpr double kMaxDeviation = 0.05;  // [m]
// Largest curvature of a lane center [1/m], and largest turn between consecutive points [rad]. The
// heading along a segment between two points (SegmentsThrough) changes by at most eleven times this
// turn, which is 5500 rad. A Path can still integrate this heading change.
constexpr double kMaxBend = 500.0;
constexpr double kMaxLength = 2e5;  // Largest length of a route's lane centers [m].

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
    // Blend the offsets of both lanes with a quintic polynomial w that rises from 0 to 1, with zero
    // first and second derivatives at both ends.
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

/// Whether the superelevation of the road moves the lanes sideways.
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

/// Returns an error message if a lane center lies beyond the road's center of curvature
/// (SurfaceLine::folded). Also returns an error message if the heading of the lane center changes
/// too much between two points that are `step` apart. Returns "" if the lane center has no such
/// error.
std::string ShapeProblem(const SurfaceLine& before, const SurfaceLine& state, double step) {
  if (state.folded) {
    return "lies beyond the road's center of curvature";
  }
  const double curvature = std::max(std::abs(before.curvature), std::abs(state.curvature));
  const double turn = std::max(curvature * step, std::abs(state.heading - before.heading));
  if (curvature <= kMaxBend && turn <= kMaxBend) {
    return "";
  }
  return fmt::format(
      "turns by {:.4g} rad over {:.3g} m (curvature {:.4g} 1/m) at x = {:.4g} m, y = {:.4g} m; "
      "correct the widths, offset or superelevation of the lane there",
      turn, step, curvature, state.position.x(), state.position.y());
}

/// The smooth pieces of a stretch's lane center in driving direction, or the reason why the lane
/// center has no pieces.
struct SmoothCenter {
  std::vector<Piece> pieces;
  std::string failure;
};

SmoothCenter SmoothPieces(const RoadStretch& own) {
  std::vector<Piece> pieces;
  const std::vector<double> joints = Joints(own);
  for (std::size_t i = 1; i < joints.size(); ++i) {
    const double length = joints[i] - joints[i - 1];
    const double middle = 0.5 * (joints[i] + joints[i - 1]);
    const auto count = static_cast<std::size_t>(std::ceil(length / kSpacing));
    const double step = length / static_cast<double>(count);
    Piece piece;
    double distance = 0.0;
    SurfaceLine before = StateAt(own, joints[i - 1], middle);
    for (std::size_t j = 0; j <= count; ++j) {
      const double s = j == count ? joints[i] : joints[i - 1] + step * static_cast<double>(j);
      double ahead = 0.0;
      if (j > 0) {
        ahead = boost::math::quadrature::gauss<double, 7>::integrate(
            [&](double at) { return StateAt(own, at, middle).speed; }, s - step, s);
      }
      const SurfaceLine state = StateAt(own, s, middle);
      if (std::string problem = ShapeProblem(before, state, ahead); !problem.empty()) {
        return {{}, std::move(problem)};
      }
      before = state;
      distance += ahead;
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
  return {std::move(pieces), ""};
}

std::string Place(const Piece& piece) {
  return fmt::format("at x = {:.4g} m, y = {:.4g} m", piece.front().position.x(),
                     piece.front().position.y());
}

/// Counts the gaps larger than kKeptOffset between lane centers, and stores the largest gap.
class Gaps {
 public:
  /// Adds a gap of `size` [m]; `place` names its position in the note.
  void Add(double size, const std::string& place) {
    if (size <= kKeptOffset) {
      return;
    }
    ++count_;
    if (size > largest_) {
      largest_ = size;
      place_ = place;
    }
  }
  /// Returns a note that states the number of gaps, and size and place of the largest gap. Returns
  /// an empty text if the lane centers have no gaps.
  [[nodiscard]] std::string Note() const {
    if (count_ == 0) {
      return "";
    }
    return fmt::format("the lanes' centers have {} {:.2g} m {}; the path closes it over {:.2g} m",
                       count_ == 1 ? "a gap of" : fmt::format("{} gaps, the largest of", count_),
                       largest_, place_, ClosingLength(largest_));
  }

 private:
  std::size_t count_ = 0;
  double largest_ = 0.0;  // [m]
  std::string place_;
};

/// Joins pieces of lane centers to one line with continuous distances and headings. Kinks between
/// pieces are rounded.
class Joiner {
 public:
  /// Adds a piece of a lane center to the end of the joined line. If the piece cannot be joined to
  /// the line, Add returns the reason, otherwise an empty text.
  std::string Add(Piece piece) {
    if (runs_.empty()) {
      runs_.push_back(std::move(piece));
      return "";
    }
    Piece& before = runs_.back();
    const CurvePoint end = before.back().curve;
    const double kink = AngleDifference(piece.front().curve.yaw, end.yaw);
    const double turn = end.yaw + kink - piece.front().curve.yaw;
    const Vec2 gap_vector = piece.front().position - before.back().position;
    const double gap = gap_vector.norm();
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
    gaps_.Add(gap, Place(piece));
    const double step = std::abs(piece.front().curve.curvature - end.curvature);
    const bool is_rounded_step = step > kSameCurvature && step <= kCurvatureStep;
    if (std::abs(kink) <= kKink && !is_rounded_step) {
      runs_.push_back(std::move(piece));
      return "";
    }
    // Remove the points around the joint that the rounding replaces, but keep the first point of
    // the line and the last point of the new piece.
    auto first = piece.begin();
    while (first + 1 != piece.end() && first->curve.s < end.s + kRounding) {
      ++first;
    }
    // Keep the path segment across the joint of two pieces short, so that it also follows pieces
    // that are shorter than the rounding.
    while (before.size() > 1 && before.back().curve.s > end.s - kRounding &&
           first->curve.s - before[before.size() - 2].curve.s <= kLongestRounding) {
      before.pop_back();
    }
    // A gap or overlap along the center line changes the length of the path segment across the
    // joint.
    const double middle = end.yaw + 0.5 * kink;
    const double along = gap_vector.dot(Vec2(std::cos(middle), std::sin(middle)));
    const double change = std::max(along, -0.5 * (first->curve.s - before.back().curve.s));
    std::for_each(first, piece.end(), [&](CenterPoint& point) { point.curve.s += change; });
    before.insert(before.end(), first, piece.end());
    return "";
  }

  [[nodiscard]] const Gaps& gaps() const { return gaps_; }

  /// Builds the path, which follows the lane centers also beyond gaps and kinks.
  [[nodiscard]] Path Join() {
    // In the first pass, CloseGaps moves the path back to the lane centers. Later passes of
    // CloseGaps correct the error of the path segments through the moved points. The remaining
    // error after a pass is less than a tenth of the path's displacement in this pass.
    constexpr int kPasses = 4;
    Path path = Through();
    for (int i = 0; i < kPasses && CloseGaps(path, runs_); ++i) {
      path = Through();
    }
    return path;
  }

 private:
  /// Builds the path through the points of all pieces. Adjacent pieces of the same straight line or
  /// arc become one segment, because planners use the distances between steps of the curvature.
  [[nodiscard]] Path Through() const {
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

  std::vector<Piece> runs_;
  Gaps gaps_;
};

/// Returns the largest distance between a point of the lane centers and the path's point beside it
/// [m].
double Deviation(const Path& path, const std::vector<Piece>& pieces) {
  double worst = 0.0;
  double station = 0.0;
  double ahead = 0.0;  // Length that gaps between pieces have added to the path so far [m].
  for (const Piece& piece : pieces) {
    for (const CenterPoint& point : piece) {
      const auto at = [&] {
        return path.At(std::clamp(station + point.curve.s + ahead, 0.0, path.length())).pose;
      };
      ahead += ToLocal(at(), point.position).x();
      worst = std::max(worst, (at().position() - point.position).norm());
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
  double length = 0.0;
  for (const LaneStretch& stretch : stretches) {
    const Road& road = network.roads.find(stretch.road)->second;
    const RoadStretch own{road, road.SectionAt(0.5 * (stretch.from + stretch.to)), stretch};
    SmoothCenter center = SmoothPieces(own);
    if (!center.failure.empty()) {
      joined.failure = fmt::format("road {}: the center of lane {} {}", stretch.road, stretch.lane,
                                   center.failure);
      return joined;
    }
    for (const Piece& piece : center.pieces) {
      length += piece.back().curve.s;
      if (!(length <= kMaxLength)) {
        joined.failure = fmt::format(
            "the lanes' centers are longer than {} km: up to lane {} of road {}, {:.4g} m",
            1e-3 * kMaxLength, stretch.lane, stretch.road, length);
        return joined;
      }
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
  joined.note = joiner.gaps().Note();
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
