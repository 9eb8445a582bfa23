#pragma once

#include <limits>
#include <vector>

#include "trackbed/geometry/pose.h"

/// The path of a car: the pose of the car's rear-axle center as a function of arc length.
///
/// Symbols: s is the station, the distance along the path [m], which grows in the direction of
/// motion; yaw is the heading of the car [rad]; kappa = tan(steering)/wheelbase is the curvature
/// [1/m], positive to the left; direction is +1 forwards and -1 backwards; e is the cross-track
/// error [m], positive if the car is left of the path.
namespace trackbed {

/// A segment of a path: a line, an arc, a clothoid, or a piece of another curve (see
/// SegmentsThrough). The curvature is at most quadratic in the distance d from the segment's start:
/// kappa(d) = curvature + sharpness d + sharpness_rate d^2/2.
struct Segment {
  double length = 0.0;          ///< Length of the segment [m], > 0.
  double curvature = 0.0;       ///< Curvature at the start of the segment [1/m].
  int direction = 1;            ///< Direction of motion: +1 forwards, -1 backwards.
  double sharpness = 0.0;       ///< Sharpness dkappa/dd at the start of the segment [1/m^2].
  double sharpness_rate = 0.0;  ///< Second derivative d^2kappa/dd^2 of the curvature [1/m^3].

  /// Returns the curvature kappa(d) at the distance d from the start [1/m].
  [[nodiscard]] double CurvatureAt(double d) const {
    return curvature + d * (sharpness + 0.5 * d * sharpness_rate);
  }

  bool operator==(const Segment&) const = default;
};

/// The point of a path at a station.
struct PathPoint {
  double s = 0.0;          ///< Station [m].
  Pose2 pose;              ///< Position of the car's rear-axle center, and heading of the car.
  double curvature = 0.0;  ///< Curvature [1/m].
  int direction = 1;
  double sharpness = 0.0;  ///< Sharpness dkappa/ds of the path [1/m^2].
};

/// Curvature and direction of a path at one station.
struct PathBend {
  double curvature = 0.0;  ///< Curvature [1/m].
  int direction = 1;
};

/// The point of a path nearest to a pose, and the errors of the pose relative to this point.
struct Projection {
  double s = 0.0;            ///< Station of the path's nearest point [m]; see Path::Project.
  double cross_track = 0.0;  ///< Cross-track error of the pose [m], positive left of the path.
  /// Heading error: yaw of the pose minus yaw of the path [rad], in (-pi, pi].
  double heading_error = 0.0;
};

/// An interval of stations on a path [m], such as the interval of a search.
struct Stations {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

/// A chain of path segments that begins at a start pose. Position and heading are continuous,
/// because each segment starts at the end of the previous segment (rounding errors stay below 1e-9
/// m over 10 km). The curvature of a path may jump between two segments. A path cannot be changed
/// after construction.
///
/// Beyond both ends, a path continues as a straight line, with stations below 0 and above length().
/// Because a path continues beyond its ends, a car near the end still has a path to follow.
///
/// A path has no time or speed (see Reference), and may have curvatures that a car cannot follow.
class Path {
 public:
  /// Makes a path of length 0 at the origin.
  Path() : Path(Pose2{}, {}) {}

  /// Throws InternalError unless every length is positive and finite, every curvature and sharpness
  /// is finite, and every direction is +1 or -1. Throws PreconditionError if the start pose is not
  /// finite, or if a segment with nonzero sharpness turns by more than 1e4 rad.
  Path(const Pose2& start, std::vector<Segment> segments);

  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }

  /// Returns the point of the path at station s. Where two segments meet, the curvature and
  /// direction are those of the segment that begins there. Beyond the ends of the path, the path's
  /// curvature is 0. Cost O(log n).
  [[nodiscard]] PathPoint At(double s) const;

  /// Returns the same curvature and direction as At(s), without the cost of computing the pose.
  [[nodiscard]] PathBend BendAt(double s) const;

  /// Finds the point of the path that is nearest to `pose`, at stations in the interval `within`.
  /// The searched interval `within` may extend beyond the ends of the path. The station of the
  /// nearest point is exact for lines and arcs, and has an error of at most 1e-9 m for other
  /// segments. If the pose is within a tenth of the radius of a center of curvature, the returned
  /// point may not be the nearest point, except on lines and arcs. Callers should limit the search
  /// for the nearest point to stations near the last known station; otherwise, the result may jump
  /// to a station at which the path crosses itself, or beyond a cusp. If several points are equally
  /// near, the point with the smallest station is returned. The cost of the search is proportional
  /// to the number of path segments in the interval `within`. Throws InternalError if `within` is
  /// empty. Throws PreconditionError if the pose is not finite.
  [[nodiscard]] Projection Project(const Pose2& pose, Stations within = {}) const;

  /// Returns evenly spaced points of the whole path, at most `spacing` [m] apart, including both
  /// ends. Throws PreconditionError if more than 2e7 points are needed.
  [[nodiscard]] std::vector<PathPoint> Sample(double spacing) const;

  /// Returns the segments of this path between the stations `from` and `to`; the first segment
  /// starts at At(from).pose. The stations `from` and `to` are clamped to the ends of the path. The
  /// returned list of segments is empty if the clamped interval has no length.
  [[nodiscard]] std::vector<Segment> Cut(Stations within) const;

 private:
  [[nodiscard]] std::size_t SegmentAt(double s) const;

  std::vector<Segment> segments_;
  // Start pose of each segment, followed by the end pose of the path.
  std::vector<Pose2> starts_;
  // Start station of each segment, followed by the length of the path.
  std::vector<double> stations_;
  double length_ = 0.0;
};

/// Splits a path into legs at the path's cusps, where a car stops and changes gear, and at the
/// stations `stops` [m]. If the path has length 0, returns one leg of length 0. Ignores `stops` at
/// or beyond the ends of the path.
std::vector<Stations> SplitIntoLegs(const Path& path, const std::vector<double>& stops = {});

/// A point on a curve, with the tangent and curvature of the curve.
struct CurvePoint {
  double s = 0.0;          ///< Distance of the point along the curve [m].
  double yaw = 0.0;        ///< Yaw of the curve's tangent at the point [rad], not wrapped.
  double curvature = 0.0;  ///< Curvature [1/m].
};

/// Returns segments that follow a smooth curve in the forward direction. Each segment connects two
/// neighboring points and has the curve's heading and curvature at both points. Between the points,
/// the heading of the segments differs from the heading of the curve by at most h^4 k/384, where h
/// is the distance of the points and k the largest third derivative of the curvature. The position
/// error at the end of the segments is at most h^4 k/720 times the length of the curve, for points
/// at the distance h and a third derivative of the curvature of at most k. The position error of
/// the segments is about 1e-7 m for points 0.1 m apart on bends that a car can drive. Throws
/// InternalError unless the distances of the points along the curve increase.
std::vector<Segment> SegmentsThrough(const std::vector<CurvePoint>& points);

}  // namespace trackbed
