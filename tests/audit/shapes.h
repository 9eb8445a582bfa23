#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

/// Plane geometry of the audit. It shares no code with the program, so that a common error cannot
/// hide.
namespace audit {

struct Point {
  double x = 0.0;  ///< [m]
  double y = 0.0;  ///< [m]
};

/// Pose of a rigid body at a time. Yaws of successive poses are continuous, not wrapped.
struct TimedPose {
  double t = 0.0;    ///< [s]
  double x = 0.0;    ///< [m]
  double y = 0.0;    ///< [m]
  double yaw = 0.0;  ///< [rad]
};

/// A rectangle in a body's frame: from `back` to `front` along x, half of `width` to either side.
struct Rectangle {
  double back = 0.0;   ///< [m]
  double front = 0.0;  ///< [m]
  double width = 0.0;  ///< [m]

  /// Largest distance of a corner from the body's origin [m].
  [[nodiscard]] double reach() const;
};

using Quad = std::array<Point, 4>;

Quad CornersAt(const Rectangle& rectangle, const TimedPose& pose);

/// Distance between two convex quads with counter-clockwise corners [m]. If the quads overlap,
/// returns minus the penetration depth, which is the length of the smallest translation that
/// separates them.
double Gap(const Quad& a, const Quad& b);

/// A box that moves at a constant velocity without turning.
struct Box {
  TimedPose center;     ///< at its time t
  double length = 0.0;  ///< along its own x [m]
  double width = 0.0;   ///< [m]
  Point velocity;       ///< [m/s]

  [[nodiscard]] Quad CornersAt(double t) const;
};

/// The closest approach of a body to a box.
struct Nearest {
  double gap = 0.0;   ///< [m]; negative: depth of the overlap
  double t = 0.0;     ///< [s]
  double step = 0.0;  ///< largest relative motion in one step there [m]
};

/// Returns the smallest gap [m], with an error of up to `resolution` [m], for a motion that is
/// linear in position and yaw between the poses. Near the smallest gap, no point of the body moves
/// by more than `resolution` between two evaluations. Exact at the poses.
Nearest SweptGap(const Rectangle& footprint, const std::vector<TimedPose>& poses, const Box& box,
                 double resolution);

/// Distance from a point to the segment between two others [m].
double DistanceToSegment(const Point& p, const Point& a, const Point& b);

/// A polyline for distance queries of successive points that are close to each other.
class Polyline {
 public:
  explicit Polyline(std::vector<Point> points);

  /// Distance to the nearest segment [m], by a search over all segments.
  [[nodiscard]] double DistanceTo(const Point& p) const;

  /// Returns the distance to the nearest of a few segments around the result of the last call. This
  /// distance is an upper bound of DistanceTo.
  double LocalDistanceTo(const Point& p);

 private:
  std::vector<Point> points_;
  std::size_t last_ = 0;
};

}  // namespace audit
