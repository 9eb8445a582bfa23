#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

/// The audit's own plane geometry. It shares nothing with the program's, so that an error there
/// cannot hide itself.
namespace audit {

struct Point {
  double x = 0.0;  ///< [m]
  double y = 0.0;  ///< [m]
};

/// Where a rigid body is at a moment. Yaws of successive poses are continuous, not wrapped.
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

/// Distance between two convex quads with corners in counter-clockwise order [m]; where they
/// overlap, minus the depth: how far one would have to move to come free.
double Gap(const Quad& a, const Quad& b);

/// A box that moves at a constant velocity without turning.
struct Box {
  TimedPose center;     ///< at its time t
  double length = 0.0;  ///< along its own x [m]
  double width = 0.0;   ///< [m]
  Point velocity;       ///< [m/s]

  [[nodiscard]] Quad CornersAt(double t) const;
};

/// The nearest that a body came to a box.
struct Nearest {
  double gap = 0.0;   ///< [m]; below 0: it overlapped by so much
  double t = 0.0;     ///< [s]
  double step = 0.0;  ///< largest motion of the two against each other in one step there [m]
};

/// The smallest gap over a motion that is linear in position and yaw between the poses, within
/// `resolution` [m]: no point of the body moves further than that between two evaluations near the
/// minimum. Exact for the poses themselves.
Nearest SweptGap(const Rectangle& footprint, const std::vector<TimedPose>& poses, const Box& box,
                 double resolution);

/// Distance from a point to the segment between two others [m].
double DistanceToSegment(const Point& p, const Point& a, const Point& b);

/// A polyline that is asked for the distance of points which move little from one to the next.
class Polyline {
 public:
  explicit Polyline(std::vector<Point> points);

  /// Distance of the nearest of its segments [m], all of them looked at.
  [[nodiscard]] double DistanceTo(const Point& p) const;

  /// Distance of the nearest segment among a few beside the one of the last call: an upper bound of
  /// DistanceTo.
  double LocalDistanceTo(const Point& p);

 private:
  std::vector<Point> points_;
  std::size_t last_ = 0;
};

}  // namespace audit
