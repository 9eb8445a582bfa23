#include "trackbed/path/path.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// Implements paths of segments with quadratic curvature. Positions on straight lines and arcs are
// computed in closed form. On other segments, ten-node Gauss quadrature integrates the position
// over pieces that turn by at most half a radian. To project a point onto the path, Project
// brackets the foot points between path points whose headings differ by a quarter radian. The
// root-finding method TOMS 748 then computes the foot points precisely. SegmentsThrough
// interpolates the heading and the curvature of given points exactly.

namespace trackbed {
namespace {

bool IsLineOrArc(const Segment& segment) {
  return segment.sharpness == 0.0 && segment.sharpness_rate == 0.0;
}

/// Returns the integral of a segment's curvature over `distance`: the heading change, not yet
/// multiplied by the segment's direction of motion.
double HeadingChange(const Segment& segment, double distance) {
  return distance * (segment.curvature + distance * (segment.sharpness / 2.0 +
                                                     distance * segment.sharpness_rate / 6.0));
}

/// Returns an upper bound of the heading change within the first `distance` of a segment.
double MaxHeadingChange(const Segment& segment, double distance) {
  return distance * (std::abs(segment.curvature) +
                     distance * (std::abs(segment.sharpness) / 2.0 +
                                 distance * std::abs(segment.sharpness_rate) / 6.0));
}

/// Returns the pose after `distance` along a segment, in the segment's direction of motion.
Pose2 Along(const Pose2& start, const Segment& segment, double distance) {
  const double moved = segment.direction * distance;
  if (IsLineOrArc(segment)) {
    return MoveOnArc(start, moved, segment.curvature * moved);
  }
  const auto yaw = [&](double d) {
    return start.yaw + segment.direction * HeadingChange(segment, d);
  };
  // With ten nodes per half radian, the quadrature integrates cosine and sine to machine precision.
  using Quadrature = boost::math::quadrature::gauss<double, 10>;
  const double pieces =
      std::max(1.0, std::ceil(2.0 * MaxHeadingChange(segment, std::abs(distance))));
  Vec2 position = start.position();
  for (double i = 0.0; i < pieces; i += 1.0) {
    const double from = distance * i / pieces;
    const double to = distance * (i + 1.0) / pieces;
    position.x() += segment.direction *
                    Quadrature::integrate([&](double d) { return std::cos(yaw(d)); }, from, to);
    position.y() += segment.direction *
                    Quadrature::integrate([&](double d) { return std::sin(yaw(d)); }, from, to);
  }
  return {position.x(), position.y(), yaw(distance)};
}

/// Implements NearestDistance for segments of varying curvature. A foot point of p is a point of
/// the segment at which the line to p is perpendicular to the segment. NearestOnCurve brackets the
/// foot points between points of the segment whose headings differ by a quarter radian.
double NearestOnCurve(const Pose2& start, const Segment& segment, const Vec2& p, double from,
                      double to) {
  // Returns how far p lies ahead of the segment's point at the distance d, measured in the
  // direction of motion at this point. At the foot point nearest to p, the function `ahead` changes
  // from positive to negative.
  const auto ahead = [&](double d) {
    return segment.direction * ToLocal(Along(start, segment, d), p).x();
  };
  const auto apart = [&](double d) { return (Along(start, segment, d).position() - p).norm(); };
  constexpr double kPrecision = 1e-10;  // [m]
  double best = apart(from) <= apart(to) ? from : to;
  const double pieces = std::max(1.0, std::ceil(4.0 * MaxHeadingChange(segment, to)));
  double left = from;
  double at_left = ahead(left);
  for (double i = 1.0; i <= pieces; i += 1.0) {
    const double right = from + (to - from) * i / pieces;
    const double at_right = ahead(right);
    if (at_left > 0.0 && at_right <= 0.0) {
      std::uintmax_t most = 50;
      const auto [low, high] = boost::math::tools::toms748_solve(
          ahead, left, right, at_left, at_right,
          [](double a, double b) { return b - a < kPrecision; }, most);
      const double foot = 0.5 * (low + high);
      best = apart(foot) < apart(best) ? foot : best;
    }
    left = right;
    at_left = at_right;
  }
  return best;
}

/// Returns the distance in [from, to] along a segment at which the segment is nearest to p. An arc
/// may pass the nearest point several times; NearestDistance then returns the smallest of these
/// distances. If the nearest point of the segment lies outside of [from, to], NearestDistance
/// returns the closer of `from` and `to`.
double NearestDistance(const Pose2& start, const Segment& segment, const Vec2& p, double from,
                       double to) {
  if (!IsLineOrArc(segment)) {
    return NearestOnCurve(start, segment, p, from, to);
  }
  const Vec2 local = ToLocal(start, p);
  if (segment.curvature == 0.0) {
    return std::clamp(segment.direction * local.x(), from, to);
  }
  const double radius = 1.0 / segment.curvature;  // radius of the arc, positive for a left turn
  const double sign = std::copysign(1.0, radius);
  const double turned = std::atan2(sign * local.x(), sign * (radius - local.y()));
  const double lap = 2.0 * kPi * std::abs(radius);
  double distance = segment.direction * radius * turned;
  // Find the first foot point on the circle that is at least `from` [m] along the segment.
  distance += lap * std::ceil((from - distance) / lap);
  if (distance <= to) {
    return distance;
  }
  // If the foot point lies outside of the range [from, to], return the end of the range that is
  // closer to the foot point along the circle.
  return (from - (distance - lap)) <= (distance - to) ? from : to;
}

}  // namespace

Path::Path(const Pose2& start, std::vector<Segment> segments) : segments_(std::move(segments)) {
  TRACKBED_REQUIRE(start.position().allFinite() && std::isfinite(start.yaw),
                   "Path: the start is {}, {}, yaw {}; must be finite", start.x, start.y,
                   start.yaw);
  starts_.reserve(segments_.size() + 1);
  stations_.reserve(segments_.size() + 1);
  starts_.push_back(start);
  stations_.push_back(0.0);
  for (const Segment& segment : segments_) {
    TRACKBED_CHECK(segment.length > 0.0 && std::isfinite(segment.length) &&
                       std::isfinite(segment.curvature) && std::isfinite(segment.sharpness) &&
                       std::isfinite(segment.sharpness_rate) && std::abs(segment.direction) == 1,
                   "segment of length {}, curvature {}, sharpness {} and {}, direction {}",
                   segment.length, segment.curvature, segment.sharpness, segment.sharpness_rate,
                   segment.direction);
    // Limits the number of quadrature pieces of a segment, which has one piece per half radian of
    // heading change.
    constexpr double kMaxHeadingChange = 1e4;
    TRACKBED_REQUIRE(
        IsLineOrArc(segment) || MaxHeadingChange(segment, segment.length) <= kMaxHeadingChange,
        "Path: a segment of {} m, curvature {}, sharpness {} and {} may turn by {} rad; "
        "must be at most {}",
        segment.length, segment.curvature, segment.sharpness, segment.sharpness_rate,
        MaxHeadingChange(segment, segment.length), kMaxHeadingChange);
    starts_.push_back(Along(starts_.back(), segment, segment.length));
    length_ += segment.length;
    // Maximum length of a path [m]; at 1e12 m, stations have rounding errors of 0.1 mm.
    constexpr double kMaxLength = 1e12;
    TRACKBED_REQUIRE(length_ <= kMaxLength, "Path: {} m; must be at most {} m", length_,
                     kMaxLength);
    stations_.push_back(length_);
  }
}

std::size_t Path::SegmentAt(double s) const {
  const auto after = std::upper_bound(stations_.begin(), stations_.end() - 1, s);
  const auto index = std::max<std::ptrdiff_t>(0, after - stations_.begin() - 1);
  return std::min(static_cast<std::size_t>(index), segments_.size() - 1);
}

PathPoint Path::At(double s) const {
  const bool before = s < 0.0;
  if (before || s > length_ || segments_.empty()) {
    const int direction =
        segments_.empty() ? 1 : (before ? segments_.front() : segments_.back()).direction;
    const double beyond = before || segments_.empty() ? s : s - length_;
    const Pose2& end = before ? starts_.front() : starts_.back();
    return {s, MoveOnArc(end, direction * beyond, 0.0), 0.0, direction};
  }
  const std::size_t i = SegmentAt(s);
  const Segment& segment = segments_[i];
  const double d = s - stations_[i];
  return {s, Along(starts_[i], segment, d), segment.CurvatureAt(d), segment.direction,
          segment.sharpness + d * segment.sharpness_rate};
}

PathBend Path::BendAt(double s) const {
  if (segments_.empty()) {
    return {};
  }
  if (s < 0.0 || s > length_) {
    return {0.0, (s < 0.0 ? segments_.front() : segments_.back()).direction};
  }
  const std::size_t i = SegmentAt(s);
  return {segments_[i].CurvatureAt(s - stations_[i]), segments_[i].direction};
}

Projection Path::Project(const Pose2& pose, Stations within) const {
  TRACKBED_CHECK(within.from <= within.to, "no station is within [{}, {}]", within.from, within.to);
  TRACKBED_REQUIRE(pose.position().allFinite() && std::isfinite(pose.yaw),
                   "Path::Project: the pose {}, {}, yaw {} is not finite", pose.x, pose.y,
                   pose.yaw);
  const Vec2 p = pose.position();
  double best_s = within.from;
  double best_distance = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Pose2& start, const Segment& segment, double station, double from,
                            double to) {
    if (from > to) {
      return;
    }
    const double along = NearestDistance(start, segment, p, from, to);
    const double distance = (Along(start, segment, along).position() - p).norm();
    if (distance < best_distance) {
      best_distance = distance;
      best_s = station + along;
    }
  };
  const Segment lead_in{1.0, 0.0, segments_.empty() ? 1 : segments_.front().direction};
  const Segment lead_out{1.0, 0.0, segments_.empty() ? 1 : segments_.back().direction};
  consider(starts_.front(), lead_in, 0.0, within.from, std::min(within.to, 0.0));
  const std::size_t first = segments_.empty() ? 0 : SegmentAt(within.from);
  for (std::size_t i = first; i < segments_.size() && stations_[i] <= within.to; ++i) {
    consider(starts_[i], segments_[i], stations_[i], std::max(within.from - stations_[i], 0.0),
             std::min(within.to - stations_[i], segments_[i].length));
  }
  consider(starts_.back(), lead_out, length_, std::max(within.from - length_, 0.0),
           within.to - length_);
  const PathPoint nearest = At(best_s);
  return {best_s, ToLocal(nearest.pose, p).y(), AngleDifference(pose.yaw, nearest.pose.yaw)};
}

std::vector<PathPoint> Path::Sample(double spacing) const {
  constexpr double kMaxPoints = 2e7;
  TRACKBED_CHECK(spacing > 0.0, "spacing {}", spacing);
  TRACKBED_REQUIRE(length_ / spacing <= kMaxPoints,
                   "Path::Sample: {} m every {} m; must be at most {} points", length_, spacing,
                   kMaxPoints);
  const auto intervals =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(length_ / spacing)));
  std::vector<PathPoint> points;
  points.reserve(intervals + 1);
  for (std::size_t i = 0; i <= intervals; ++i) {
    points.push_back(At(i == intervals
                            ? length_
                            : length_ * static_cast<double>(i) / static_cast<double>(intervals)));
  }
  return points;
}

std::vector<Segment> Path::Cut(Stations within) const {
  TRACKBED_REQUIRE(!std::isnan(within.from) && !std::isnan(within.to),
                   "Path::Cut: stations {} and {}; must be numbers", within.from, within.to);
  std::vector<Segment> pieces;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& whole = segments_[i];
    // If the range begins or ends where two segments meet, exclude the segment outside of the
    // range, even if stations have rounding errors.
    const double end = stations_[i + 1];
    const double from =
        within.from >= end ? whole.length : std::max(within.from - stations_[i], 0.0);
    const double to = within.to >= end ? whole.length : within.to - stations_[i];
    if (to > from) {
      pieces.push_back({to - from, whole.CurvatureAt(from), whole.direction,
                        whole.sharpness + from * whole.sharpness_rate, whole.sharpness_rate});
    }
  }
  return pieces;
}

std::vector<Stations> SplitIntoLegs(const Path& path, const std::vector<double>& stops) {
  constexpr double kSameStation = 1e-9;  // [m]
  for (const double stop : stops) {
    TRACKBED_REQUIRE(!std::isnan(stop), "SplitIntoLegs: a stop at {}; must be a number", stop);
  }
  std::vector<double> ends = stops;
  const std::vector<Segment>& segments = path.segments();
  double station = 0.0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (i > 0 && segments[i].direction != segments[i - 1].direction) {
      ends.push_back(station);
    }
    station += segments[i].length;
  }
  std::sort(ends.begin(), ends.end());
  std::vector<Stations> legs{{0.0, 0.0}};
  for (const double end : ends) {
    if (end > legs.back().from + kSameStation && end < station - kSameStation) {
      legs.back().to = end;
      legs.push_back({end, end});
    }
  }
  legs.back().to = station;
  return legs;
}

std::vector<Segment> SegmentsThrough(const std::vector<CurvePoint>& points) {
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const CurvePoint& a = points[i - 1];
    const CurvePoint& b = points[i];
    const double h = b.s - a.s;
    TRACKBED_CHECK(h > 0.0, "points at {} and {} m", a.s, b.s);
    // Choose the quadratic curvature profile with the given curvatures at both ends whose integral
    // equals the given change of heading.
    const double mean = (b.yaw - a.yaw) / h;
    segments.push_back({h, a.curvature, 1, (6.0 * mean - 4.0 * a.curvature - 2.0 * b.curvature) / h,
                        6.0 * (a.curvature + b.curvature - 2.0 * mean) / (h * h)});
  }
  return segments;
}

}  // namespace trackbed
