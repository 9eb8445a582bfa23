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
  double length = 0.0;          ///< [m], > 0
  double curvature = 0.0;       ///< at its start [1/m]
  int direction = 1;            ///< +1 forwards, -1 backwards
  double sharpness = 0.0;       ///< dkappa/dd at its start [1/m^2]
  double sharpness_rate = 0.0;  ///< d^2kappa/dd^2 [1/m^3]

  /// kappa(d) [1/m].
  [[nodiscard]] double CurvatureAt(double d) const {
    return curvature + d * (sharpness + 0.5 * d * sharpness_rate);
  }

  bool operator==(const Segment&) const = default;
};

/// A point of a path at one station.
struct PathPoint {
  double s = 0.0;          ///< [m]
  Pose2 pose;              ///< rear-axle center, heading of the car
  double curvature = 0.0;  ///< [1/m]
  int direction = 1;
  double sharpness = 0.0;  ///< dkappa/ds [1/m^2]
};

/// Curvature and direction of a path at one station.
struct PathBend {
  double curvature = 0.0;  ///< [1/m]
  int direction = 1;
};

/// The point of a path nearest to a pose, and the errors of the pose relative to it.
struct Projection {
  double s = 0.0;              ///< station of the nearest point [m]; see Path::Project
  double cross_track = 0.0;    ///< [m], positive left of the path
  double heading_error = 0.0;  ///< yaw of the pose minus yaw of the path [rad], in (-pi, pi]
};

/// An interval of stations [m] to search.
struct Stations {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

/// A chain of segments from a start pose. Position and heading are continuous by construction (each
/// segment starts at the end of the previous one, to rounding: below 1e-9 m over 10 km); curvature
/// may jump between segments. Immutable.
///
/// Beyond its start and end a path continues straight along its end tangents, with stations below 0
/// and above length(): a car near the end of its path still has a path to follow.
///
/// Has no time or speed (see Reference), and does not know whether a car can follow it.
class Path {
 public:
  /// A path of length 0 at the origin.
  Path() : Path(Pose2{}, {}) {}

  /// InternalError unless every length is positive and finite, every curvature and sharpness
  /// finite, every direction +1 or -1. PreconditionError unless the start is finite and no segment
  /// with sharpness turns by more than 1e4 rad.
  Path(const Pose2& start, std::vector<Segment> segments);

  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }

  /// The point at station s. At a joint, the curvature and direction are those of the segment that
  /// begins there; on the straight continuations the curvature is 0. Cost O(log n).
  [[nodiscard]] PathPoint At(double s) const;

  /// The curvature and direction of At(s), without the cost of its pose.
  [[nodiscard]] PathBend BendAt(double s) const;

  /// The nearest point to `pose` among the stations of `within`, which may extend beyond the ends.
  /// Exact for lines and arcs, to 1e-9 m along the path for other segments. For a pose within a
  /// tenth of the radius from a center of curvature of such a segment, most of which is then about
  /// equally far, the result may not be the nearest point. Limiting the search to stations near the
  /// last known one keeps a car from jumping to a later crossing or over a cusp. Ties go to the
  /// smallest station. Cost O(segments within the stations). InternalError when `within` is empty,
  /// PreconditionError for a pose that is not finite.
  [[nodiscard]] Projection Project(const Pose2& pose, Stations within = {}) const;

  /// Evenly spaced points, at most `spacing` [m] apart, over the whole path including both ends.
  /// PreconditionError for more than 2e7 points.
  [[nodiscard]] std::vector<PathPoint> Sample(double spacing) const;

  /// The segments between two stations, cut there: starting at At(from).pose, they follow this path
  /// up to `to`. Stations are clamped to the ends; empty if nothing remains.
  [[nodiscard]] std::vector<Segment> Cut(Stations within) const;

 private:
  [[nodiscard]] std::size_t SegmentAt(double s) const;

  std::vector<Segment> segments_;
  std::vector<Pose2> starts_;     // of each segment, and the end
  std::vector<double> stations_;  // of each start, and the length
  double length_ = 0.0;
};

/// Splits a path at its cusps, where a car stops and changes gear, and at the `stops` [m]. Returns
/// one leg of length 0 for a path of length 0. Ignores stops at or beyond the ends of the path.
std::vector<Stations> SplitIntoLegs(const Path& path, const std::vector<double>& stops = {});

/// A point that a curve passes through.
struct CurvePoint {
  double s = 0.0;          ///< distance along the curve [m]
  double yaw = 0.0;        ///< of its tangent [rad], not wrapped
  double curvature = 0.0;  ///< [1/m]
};

/// Segments that follow a smooth curve forwards: one between each two neighbors, matching the
/// curve's heading and curvature at both. With points h apart and k the largest third derivative of
/// the curvature, headings between points are off by at most h^4 k/384, and the end by h^4 k/720
/// times the length: about 1e-7 m for points 0.1 m apart on bends that a car drives. InternalError
/// unless the distances rise.
std::vector<Segment> SegmentsThrough(const std::vector<CurvePoint>& points);

}  // namespace trackbed
