#include "trackbed/track/track.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <utility>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/bezier.h"

namespace trackbed {
namespace {

/// The center line as a curve over the parameter of its spline.
class Curve {
 public:
  Curve(ClosedSplineBasis basis, Eigen::MatrixXd coefficients)
      : basis_(basis), coefficients_(std::move(coefficients)) {}

  [[nodiscard]] Vec2 At(double t, std::size_t order) const {
    return Evaluate(basis_.At(t), coefficients_, order).transpose();
  }
  [[nodiscard]] double Length(double from, double to) const {
    return boost::math::quadrature::gauss<double, 7>::integrate(
        [&](double t) { return At(t, 1).norm(); }, from, to);
  }
  /// `s` and the yaw, which follows that of the point before.
  [[nodiscard]] CurvePoint PointAt(double t, double s, double yaw_before) const {
    const Vec2 tangent = At(t, 1);
    const double yaw = std::atan2(tangent.y(), tangent.x());
    return {.s = s,
            .yaw = yaw_before + AngleDifference(yaw, yaw_before),
            .curvature = CurvatureFromDerivatives(tangent, At(t, 2))};
  }

 private:
  ClosedSplineBasis basis_;
  Eigen::MatrixXd coefficients_;
};

void CheckPoints(const std::vector<TrackPoint>& points) {
  TRACKBED_REQUIRE(points.size() >= Track::kMinPoints && points.size() <= Track::kMaxPoints,
                   "Track: {} points; must be {} to {}", points.size(), Track::kMinPoints,
                   Track::kMaxPoints);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TrackPoint& point = points[i];
    TRACKBED_REQUIRE(
        point.position.allFinite() && std::isfinite(point.width_right) &&
            std::isfinite(point.width_left) && point.width_right > 0.0 && point.width_left > 0.0,
        "Track: point {} at {}, {} with widths {} and {}; must be finite, the widths "
        "above 0",
        i, point.position.x(), point.position.y(), point.width_right, point.width_left);
    TRACKBED_REQUIRE(point.position != points[(i + 1) % points.size()].position,
                     "Track: point {} is repeated", i);
  }
}

double Wrapped(double s, double length) {
  const double wrapped = s - length * std::floor(s / length);
  return wrapped < length ? wrapped : 0.0;
}

}  // namespace

Track::Track(std::vector<TrackPoint> points, std::optional<double> smoothing)
    : points_(std::move(points)) {
  CheckPoints(points_);
  TRACKBED_REQUIRE(!smoothing || (std::isfinite(*smoothing) && *smoothing > 0.0),
                   "Track: smoothing {}; must be above 0", *smoothing);
  smoothing_ = smoothing.value_or(0.0);
  FitCenterLine();
  PlaceEdges();
}

void Track::FitCenterLine() {
  const std::size_t count = points_.size();
  // Over the length of the chords; each point stands for half of both beside it.
  SplineSamples samples;
  samples.values.resize(static_cast<Eigen::Index>(count), 2);
  std::vector<double> chords(count);
  double period = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    chords[i] = (points_[(i + 1) % count].position - points_[i].position).norm();
    samples.t.push_back(period);
    samples.values.row(static_cast<Eigen::Index>(i)) = points_[i].position.transpose();
    period += chords[i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    samples.weights.push_back(0.5 * (chords[(i + count - 1) % count] + chords[i]));
  }
  if (smoothing_ == 0.0) {
    smoothing_ = 4.0 * period / static_cast<double>(count);
  }
  const ClosedSplineBasis basis(period, 2 * count);
  const Curve curve(basis, FitClosedSpline(basis, samples, smoothing_));

  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double deviation = (curve.At(samples.t[i], 0) - points_[i].position).norm();
    deviation_max_ = std::max(deviation_max_, deviation);
    squares += deviation * deviation;
  }
  deviation_rms_ = std::sqrt(squares / static_cast<double>(count));

  // Points at least every quarter of the mean distance, and at those of the track.
  const double step = 0.25 * period / static_cast<double>(count);
  std::vector<CurvePoint> lap;
  const Vec2 first_tangent = curve.At(0.0, 1);
  double yaw = std::atan2(first_tangent.y(), first_tangent.x());
  double s = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    stations_.push_back(s);
    const double parts = std::ceil(chords[i] / step);
    for (double k = 0.0; k < parts; k += 1.0) {
      const double t = samples.t[i] + chords[i] * k / parts;
      lap.push_back(curve.PointAt(t, s, yaw));
      yaw = lap.back().yaw;
      s += curve.Length(t, samples.t[i] + chords[i] * (k + 1.0) / parts);
    }
  }
  length_ = s;
  const CurvePoint end = curve.PointAt(period, length_, yaw);
  const double turn = end.yaw - lap.front().yaw;

  // The path begins before the start line and ends after it.
  const double extra = std::min(0.5 * length_, 100.0);
  const auto begin = std::find_if(lap.begin(), lap.end(),
                                  [&](const CurvePoint& p) { return p.s >= length_ - extra; });
  extra_ = length_ - begin->s;
  std::vector<CurvePoint> all;
  for (auto point = begin; point != lap.end(); ++point) {
    all.push_back({point->s - length_, point->yaw - turn, point->curvature});
  }
  all.insert(all.end(), lap.begin(), lap.end());
  for (auto point = lap.begin(); point->s <= extra; ++point) {
    all.push_back({point->s + length_, point->yaw + turn, point->curvature});
  }
  // Its place at the start line is the curve's: the path before it leads there backwards.
  const std::vector<Segment> segments = SegmentsThrough(all);
  const Path from_origin({0.0, 0.0, all.front().yaw}, segments);
  const Vec2 shift = curve.At(0.0, 0) - from_origin.At(extra_).pose.position();
  path_ = Path({shift.x(), shift.y(), all.front().yaw}, segments);
}

void Track::PlaceEdges() {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    // Seen from the smoothed line the point itself is a little off.
    const double own = Locate(points_[i].position, stations_[i]).offset;
    edges_.push_back({own + points_[i].width_left, own - points_[i].width_right});
  }
  const double count = std::ceil(length_ / kEdgeSpacing);
  for (double k = 0.0; k < count; k += 1.0) {
    const double s = length_ * k / count;
    const Pose2 pose = At(s).pose;
    const TrackEdges edges = EdgesAt(s);
    left_.push_back(ToWorld(pose, {0.0, edges.left}));
    right_.push_back(ToWorld(pose, {0.0, edges.right}));
  }
}

PathPoint Track::At(double s) const {
  PathPoint point = path_.At(extra_ + Wrapped(s, length_));
  point.s -= extra_;
  return point;
}

TrackEdges Track::EdgesAt(double s) const {
  const double station = Wrapped(s, length_);
  const auto after = std::upper_bound(stations_.begin(), stations_.end(), station);
  const auto i = static_cast<std::size_t>(after - stations_.begin()) - 1;
  const std::size_t next = (i + 1) % stations_.size();
  const double end = next == 0 ? length_ : stations_[next];
  const double share = (station - stations_[i]) / (end - stations_[i]);
  return {std::lerp(edges_[i].left, edges_[next].left, share),
          std::lerp(edges_[i].right, edges_[next].right, share)};
}

TrackPlace Track::Locate(const Vec2& point, std::optional<double> near) const {
  Stations within{.from = extra_, .to = extra_ + length_};
  if (near) {
    const double reach = std::min(30.0, 0.1 * length_);
    const double middle = extra_ + Wrapped(*near, length_);
    within = {middle - reach, middle + reach};
  }
  const Projection found = path_.Project({point.x(), point.y(), 0.0}, within);
  return {Wrapped(found.s - extra_, length_), found.cross_track};
}

std::optional<FrenetState> Track::ToFrenet(const MotionState& motion) const {
  std::optional<FrenetState> state =
      trackbed::ToFrenet(path_, motion, {.from = extra_, .to = extra_ + length_});
  if (state) {
    state->s = Wrapped(state->s - extra_, length_);
  }
  return state;
}

std::optional<TrackFold> FindFold(const Track& track) {
  constexpr double kMost = 0.95;  // of the radius
  for (std::size_t i = 0; i < track.points().size(); ++i) {
    const double from = track.StationOf(i);
    const bool is_last = i + 1 == track.points().size();
    const double to = is_last ? track.length() : track.StationOf(i + 1);
    for (int k = 0; k < 4; ++k) {
      const double s = std::lerp(from, to, 0.25 * k);
      const double curvature = track.At(s).curvature;
      const TrackEdges edges = track.EdgesAt(s);
      const double width = curvature > 0.0 ? edges.left : -edges.right;
      if (std::abs(curvature) * width > kMost) {
        return TrackFold{i, 1.0 / std::abs(curvature), width};
      }
    }
  }
  return std::nullopt;
}

}  // namespace trackbed
