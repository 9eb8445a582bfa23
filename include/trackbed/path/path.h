#pragma once

#include <limits>
#include <vector>

#include "trackbed/geometry/pose.h"

/// Paths of a car: poses of its rear-axle center over arc length.
///
/// Symbols: s station, the distance along the path [m], growing in the direction of motion;
/// yaw heading of the car [rad]; kappa = tan(steering)/wheelbase curvature [1/m], positive to the
/// left; direction +1 forwards, -1 backwards; e cross-track error [m], positive when the car is
/// left of the path.
namespace trackbed {

/// A piece of path whose curvature is at most quadratic in the distance d from its start,
/// kappa(d) = curvature + sharpness d + sharpness_rate d^2/2: a line, an arc, a clothoid, or a
/// piece of another curve (see SegmentsThrough).
struct Segment {
  double length = 0.0;          ///< Length [m], > 0.
  double curvature = 0.0;       ///< Curvature at the start [1/m].
  int direction = 1;            ///< Direction: +1 forwards, -1 backwards.
  double sharpness = 0.0;       ///< Sharpness dkappa/dd at the start [1/m^2].
  double sharpness_rate = 0.0;  ///< Rate of the sharpness, d^2kappa/dd^2 [1/m^3].

  /// The curvature kappa(d) [1/m].
  [[nodiscard]] double CurvatureAt(double d) const {
    return curvature + d * (sharpness + 0.5 * d * sharpness_rate);
  }

  bool operator==(const Segment&) const = default;
};

/// A point of a path at one station.
struct PathPoint {
  double s = 0.0;          ///< Station [m].
  Pose2 pose;              ///< Position of the rear-axle center, heading of the car.
  double curvature = 0.0;  ///< Curvature [1/m].
  int direction = 1;
  double sharpness = 0.0;  ///< Sharpness dkappa/ds [1/m^2].
};

/// Curvature and direction of a path at one station.
struct PathBend {
  double curvature = 0.0;  ///< Curvature [1/m].
  int direction = 1;
};

/// The point of a path nearest to a pose, and the errors of the pose relative to it.
struct Projection {
  double s = 0.0;              ///< Station of the nearest point [m]; see Path::Project.
  double cross_track = 0.0;    ///< Cross-track error [m], positive left of the path.
  double heading_error = 0.0;  ///< Yaw of the pose minus yaw of the path [rad], in (-pi, pi].
};

/// An interval of stations [m] to search.
struct Stations {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

/// A chain of segments from a start pose. Position and heading are continuous, because each segment
/// starts at the end of the previous one (to rounding: below 1e-9 m over 10 km). The curvature may
/// jump between segments. A path is immutable.
///
/// Beyond its start and end a path continues straight along its end tangents, with stations below 0
/// and above length(). A car near the end of its path thus still has a path to follow.
///
/// A path has no time or speed (see Reference), and may have curvatures that a car cannot follow.
class Path {
 public:
  /// A path of length 0 at the origin.
  Path() : Path(Pose2{}, {}) {}

  /// InternalError unless every length is positive and finite, every curvature and sharpness is
  /// finite, and every direction is +1 or -1. PreconditionError unless the start is finite and no
  /// segment with sharpness turns by more than 1e4 rad.
  Path(const Pose2& start, std::vector<Segment> segments);

  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }

  /// Returns the point at station s. At a joint, the curvature and direction are those of the
  /// segment that begins at the joint. On the straight continuations, the curvature is 0. Cost
  /// O(log n).
  [[nodiscard]] PathPoint At(double s) const;

  /// The curvature and direction of At(s), without the cost of computing the pose.
  [[nodiscard]] PathBend BendAt(double s) const;

  /// Finds the point of the path nearest to `pose`, among the stations of `within`, which may
  /// extend beyond the ends of the path. The result is exact for lines and arcs, and to 1e-9 m
  /// along the path for other segments. On segments other than lines and arcs, the result may not
  /// be the nearest point if the pose is within a tenth of the radius from a center of curvature.
  /// Limit the search to stations near the last known station, so that the result does not jump to
  /// a later crossing of the path or over a cusp. Among equally near points, the one with the
  /// smallest station is returned. Cost O(segments within the stations). InternalError when
  /// `within` is empty, PreconditionError for a pose that is not finite.
  [[nodiscard]] Projection Project(const Pose2& pose, Stations within = {}) const;

  /// Evenly spaced points, at most `spacing` [m] apart, over the whole path including both ends.
  /// PreconditionError for more than 2e7 points.
  [[nodiscard]] std::vector<PathPoint> Sample(double spacing) const;

  /// Returns the segments between two stations: they start at At(from).pose and follow this path up
  /// to `to`. Stations are clamped to the ends of the path. The result is empty if no length
  /// remains.
  [[nodiscard]] std::vector<Segment> Cut(Stations within) const;

 private:
  [[nodiscard]] std::size_t SegmentAt(double s) const;

  std::vector<Segment> segments_;
  std::vector<Pose2> starts_;     // Start pose of each segment, and the end pose.
  std::vector<double> stations_;  // Start station of each segment, and the path length.
  double length_ = 0.0;
};

/// Splits a path at its cusps, where a car stops and changes gear, and at the `stops` [m]. Returns
/// one leg of length 0 for a path of length 0. Ignores stops at or beyond the ends of the path.
std::vector<Stations> SplitIntoLegs(const Path& path, const std::vector<double>& stops = {});

/// A point that a curve passes through.
struct CurvePoint {
  double s = 0.0;          ///< Distance along the curve [m].
  double yaw = 0.0;        ///< Yaw of the tangent [rad], not wrapped.
  double curvature = 0.0;  ///< Curvature [1/m].
};

/// Returns segments that follow a smooth curve in the forward direction. Each segment connects two
/// neighboring points and matches the curve's heading and curvature at both. With h the distance of
/// the points and k the largest third derivative of the curvature, the heading error between points
/// is at most h^4 k/384. The error of the end point is at most h^4 k/720 times the length: about
/// 1e-7 m for points 0.1 m apart on bends that a car can drive. InternalError unless the distances
/// increase.
std::vector<Segment> SegmentsThrough(const std::vector<CurvePoint>& points);

}  // namespace trackbed
