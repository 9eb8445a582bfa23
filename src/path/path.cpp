#include "trackbed/path/path.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Where a segment gets after `distance` in its own direction of motion.
Pose2 Along(const Pose2& start, const Segment& segment, double distance) {
  const double moved = segment.direction * distance;
  return MoveOnArc(start, moved, segment.curvature * moved);
}

/// The distance along an (unbounded) segment to its point nearest to p, for arcs the one with the
/// smallest distance that is not below `from`, if there is one up to `to`.
double NearestDistance(const Pose2& start, const Segment& segment, const Vec2& p, double from,
                       double to) {
  const Vec2 local = ToLocal(start, p);
  if (segment.curvature == 0.0) {
    return std::clamp(segment.direction * local.x(), from, to);
  }
  const double radius = 1.0 / segment.curvature;  // signed
  const double sign = std::copysign(1.0, radius);
  const double turned = std::atan2(sign * local.x(), sign * (radius - local.y()));
  const double lap = 2.0 * kPi * std::abs(radius);
  double distance = segment.direction * radius * turned;
  distance += lap * std::ceil((from - distance) / lap);  // the first one not below `from`
  if (distance <= to) {
    return distance;
  }
  // The foot lies outside: the nearer end of the stretch, measured along the circle.
  return (from - (distance - lap)) <= (distance - to) ? from : to;
}

}  // namespace

Path::Path(const Pose2& start, std::vector<Segment> segments) : segments_(std::move(segments)) {
  starts_.reserve(segments_.size() + 1);
  stations_.reserve(segments_.size() + 1);
  starts_.push_back(start);
  stations_.push_back(0.0);
  for (const Segment& segment : segments_) {
    TRACKBED_CHECK(segment.length > 0.0 && std::isfinite(segment.length) &&
                       std::isfinite(segment.curvature) && std::abs(segment.direction) == 1,
                   "segment of length {}, curvature {}, direction {}", segment.length,
                   segment.curvature, segment.direction);
    starts_.push_back(Along(starts_.back(), segment, segment.length));
    length_ += segment.length;
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
  return {s, Along(starts_[i], segments_[i], s - stations_[i]), segments_[i].curvature,
          segments_[i].direction};
}

Projection Path::Project(const Pose2& pose, Stations within) const {
  TRACKBED_CHECK(within.from <= within.to, "no station is within [{}, {}]", within.from, within.to);
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
  TRACKBED_CHECK(spacing > 0.0, "spacing {}", spacing);
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

}  // namespace trackbed
