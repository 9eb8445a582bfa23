#include "trackbed/track/track.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "src/track/smooth_line.h"
#include "src/track/track_fold.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// A closed track: a smooth center line with edges.
// 1. A closed B-spline of degree 5 over the chord length smooths the points (closed_spline.h).
// 2. CenterLine samples the spline, and computes station, yaw and curvature of each sample. The
//    spline's arc length is integrated by Gauss quadrature.
// 3. BuildPath makes a path that covers one lap and extends beyond the lap's start and end.
// 4. PlaceEdges corrects the widths by the distance by which smoothing moved the center line.
// 5. FindFold finds places where an edge lies beyond the center of curvature, and thus folds over.
namespace trackbed {
namespace {

void CheckArguments(const std::vector<TrackPoint>& points, std::optional<double> smoothing) {
  TRACKBED_REQUIRE(!smoothing || (std::isfinite(*smoothing) && *smoothing > 0.0),
                   "Track: smoothing {}; must be above 0", *smoothing);
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

/// The smoothed center line, as points along a lap from which the path is built.
struct Track::CenterLine {
  double smoothing = 0.0;          // Wavelength that determines the strength of the smoothing [m].
  std::vector<double> deviations;  // Deviation of each track point from the smoothed line, positive
                                   // to the left [m].
  std::vector<double> stations;    // Station of each track point on the smoothed line [m].
  std::vector<std::size_t> first;  // Index in the list `lap` of the sample at each track point.
  // Points of the smoothed line along a lap, beginning at the start line.
  std::vector<CurvePoint> lap;
  CurvePoint end;        // Point of the smoothed line at the start line after one lap.
  Vec2 start{0.0, 0.0};  // Position at which the smoothed line begins [m].

  [[nodiscard]] const CurvePoint& After(std::size_t i) const {
    return i + 1 < lap.size() ? lap[i + 1] : end;
  }
};

Track::CenterLine Track::Smooth(const std::vector<TrackPoint>& points,
                                std::optional<double> smoothing) {
  const std::size_t count = points.size();
  const SmoothLine smooth(points, smoothing);
  CenterLine line;
  line.smoothing = smooth.smoothing();
  line.start = smooth.At(0.0, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 apart = points[i].position - smooth.At(smooth.parameters()[i], 0);
    line.deviations.push_back(
        std::copysign(apart.norm(), Cross(smooth.At(smooth.parameters()[i], 1), apart)));
  }
  // Sample the smoothed line at the track points and between the track points.
  const double step = 0.5 * smooth.knot_distance();
  const Vec2 first_tangent = smooth.At(0.0, 1);
  double yaw = std::atan2(first_tangent.y(), first_tangent.x());
  double s = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    line.stations.push_back(s);
    line.first.push_back(line.lap.size());
    const double parts = std::ceil(smooth.chords()[i] / step);
    for (double k = 0.0; k < parts; k += 1.0) {
      const double t = smooth.parameters()[i] + smooth.chords()[i] * k / parts;
      line.lap.push_back(smooth.PointAt(t, s, yaw));
      yaw = line.lap.back().yaw;
      s += smooth.Length(t, smooth.parameters()[i] + smooth.chords()[i] * (k + 1.0) / parts);
    }
  }
  line.end = smooth.PointAt(smooth.period(), s, yaw);
  return line;
}

Track::Track(std::vector<TrackPoint> points, std::optional<double> smoothing)
    : points_(std::move(points)) {
  CheckArguments(points_, smoothing);
  const CenterLine line = Smooth(points_, smoothing);
  smoothing_ = line.smoothing;
  double squares = 0.0;
  for (const double deviation : line.deviations) {
    deviation_max_ = std::max(deviation_max_, std::abs(deviation));
    squares += deviation * deviation;
  }
  deviation_rms_ = std::sqrt(squares / static_cast<double>(points_.size()));
  BuildPath(line);
  PlaceEdges(line);
}

void Track::BuildPath(const CenterLine& line) {
  stations_ = line.stations;
  length_ = line.end.s;
  const std::vector<CurvePoint>& lap = line.lap;
  const double turn = line.end.yaw - lap.front().yaw;

  // The path begins before the start line, covers one lap and ends beyond the start line.
  const double extra = std::min(0.5 * length_, 100.0);
  auto begin = std::find_if(lap.begin(), lap.end(),
                            [&](const CurvePoint& p) { return p.s >= length_ - extra; });
  // If no point is within the distance `extra` of the lap's end, begin at the last point of the
  // lap.
  begin = begin == lap.end() ? std::prev(begin) : begin;
  extra_ = length_ - begin->s;
  std::vector<CurvePoint> all;
  for (auto point = begin; point != lap.end(); ++point) {
    all.push_back({point->s - length_, point->yaw - turn, point->curvature});
  }
  all.insert(all.end(), lap.begin(), lap.end());
  for (auto point = lap.begin(); point->s <= extra; ++point) {
    all.push_back({point->s + length_, point->yaw + turn, point->curvature});
  }
  // Shift the path such that the path and the spline curve have the same position at the start
  // line.
  const std::vector<Segment> segments = SegmentsThrough(all);
  const Path from_origin({0.0, 0.0, all.front().yaw}, segments);
  const Vec2 shift = line.start - from_origin.At(extra_).pose.position();
  path_ = Path({shift.x(), shift.y(), all.front().yaw}, segments);
}

void Track::PlaceEdges(const CenterLine& line) {
  const double pieces = static_cast<double>(line.lap.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    // Compute the lateral offset of each track point from the smoothed line, because the smoothing
    // moves the line. The foot point is the point of the smoothed line nearest to a track point. If
    // the line's radius of curvature exceeds the track point's deviation, the stations of foot
    // point and track point differ by at most twice the deviation.
    const double reach = 4.0 * std::abs(line.deviations[i]) + 4.0 * length_ / pieces;
    const double own = LocateWithin(points_[i].position, stations_[i], reach).offset;
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
  return near ? LocateWithin(point, *near, 30.0)
              : PlaceOf(path_.Project({point.x(), point.y(), 0.0},
                                      {.from = extra_, .to = extra_ + length_}));
}

TrackPlace Track::LocateWithin(const Vec2& point, double near, double reach) const {
  reach = std::min(reach, std::min(30.0, 0.1 * length_));
  const double middle = extra_ + Wrapped(near, length_);
  return PlaceOf(path_.Project({point.x(), point.y(), 0.0}, {middle - reach, middle + reach}));
}

TrackPlace Track::PlaceOf(const Projection& found) const {
  return {Wrapped(found.s - extra_, length_), found.cross_track};
}

std::optional<Stations> Track::StretchAlong(const Pose2& pose) const {
  const double count =
      std::max(4.0 * static_cast<double>(points_.size()), std::ceil(length_ / kEdgeSpacing));
  const double spacing = length_ / count;
  std::optional<Stations> nearest;
  double distance = std::numeric_limits<double>::infinity();
  std::optional<Stations> stretch;
  for (double k = 0.0; k <= count; k += 1.0) {
    const double s = extra_ + k * spacing;
    const bool along = std::cos(path_.At(s).pose.yaw - pose.yaw) > 0.0;
    if (along) {
      stretch = Stations{.from = stretch ? stretch->from : std::max(extra_, s - spacing),
                         .to = std::min(extra_ + length_, s + spacing)};
    }
    if (stretch && (!along || k == count)) {
      const Vec2 foot = path_.At(path_.Project(pose, *stretch).s).pose.position();
      const double away = (foot - pose.position()).norm();
      if (away < distance) {
        distance = away;
        nearest = stretch;
      }
      stretch.reset();
    }
  }
  return nearest;
}

std::optional<FrenetState> Track::ToFrenet(const MotionState& motion) const {
  const std::optional<Stations> stretch = StretchAlong(motion.pose);
  std::optional<FrenetState> state =
      stretch ? trackbed::ToFrenet(path_, motion, *stretch) : std::nullopt;
  if (state) {
    state->s = Wrapped(state->s - extra_, length_);
  }
  return state;
}

namespace {

/// Largest |curvature| of a piece of the center line, and an upper bound of the heading change
/// within this piece.
struct PieceBend {
  double curvature = 0.0;  // [1/m]
  double turn = 0.0;       // [rad]
};

PieceBend BendOf(const CurvePoint& from, const CurvePoint& to) {
  const double length = to.s - from.s;
  if (!(length > 0.0)) {
    return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  const Segment piece = SegmentsThrough({from, to}).front();
  PieceBend bend{std::max(std::abs(from.curvature), std::abs(to.curvature))};
  const double vertex = -piece.sharpness / piece.sharpness_rate;
  if (vertex > 0.0 && vertex < length) {
    bend.curvature = std::max(bend.curvature, std::abs(piece.CurvatureAt(vertex)));
  }
  bend.turn = bend.curvature * length;
  return bend;
}

}  // namespace

std::optional<TrackFold> FindFold(const std::vector<TrackPoint>& points,
                                  std::optional<double> smoothing) {
  CheckArguments(points, smoothing);
  const Track::CenterLine line = Track::Smooth(points, smoothing);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t next = (i + 1) % points.size();
    const std::size_t end = next == 0 ? line.lap.size() : line.first[next];
    for (std::size_t k = line.first[i]; k < end; ++k) {
      const PieceBend bend = BendOf(line.lap[k], line.After(k));
      const bool is_left = line.lap[k].curvature > 0.0;
      const auto width = [&](std::size_t at) {
        return is_left ? points[at].width_left + line.deviations[at]
                       : points[at].width_right - line.deviations[at];
      };
      const double inner = std::min(width(i), width(next));
      // Ignore smaller folds of the edges in this search, because FindFold finds them when it
      // checks the finished track.
      if (bend.turn > kPi || bend.curvature * inner > 1.0) {
        return TrackFold{i, 1.0 / bend.curvature, inner, bend.turn};
      }
    }
  }
  return std::nullopt;
}

std::optional<TrackFold> FindFold(const Track& track) {
  for (std::size_t i = 0; i < track.points().size(); ++i) {
    for (int k = 0; k < kFoldSamples; ++k) {
      const double s = StationOfSample(track, i, k);
      const double curvature = track.At(s).curvature;
      const TrackEdges edges = track.EdgesAt(s);
      const double width = curvature > 0.0 ? edges.left : -edges.right;
      if (std::abs(curvature) * width > kMaxRadiusFraction) {
        return TrackFold{i, 1.0 / std::abs(curvature), width};
      }
    }
  }
  return std::nullopt;
}

}  // namespace trackbed
