#pragma once

#include <array>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A rectangle in the plane, rotated by the yaw of its pose.
struct OrientedBox {
  Pose2 center;         ///< Pose of the middle; the x axis runs along the length.
  double length = 0.0;  ///< Extent along the x axis of the rectangle [m], > 0.
  double width = 0.0;   ///< Extent along the y axis of the rectangle [m], > 0.

  /// The corners in counter-clockwise order, starting with the front left one.
  [[nodiscard]] std::array<Vec2, 4> Corners() const;
};

/// A rectangle that moves at constant velocity, without rotation.
struct MovingBox {
  OrientedBox box;          ///< Rectangle at time 0.
  Vec2 velocity{0.0, 0.0};  ///< Velocity [m/s].

  /// The rectangle at the given time [s].
  [[nodiscard]] OrientedBox At(double time) const;
};

/// Whether a point lies within a rectangle or on its border.
bool Contains(const OrientedBox& box, const Vec2& point);

/// Shortest distance between two rectangles [m]. For overlapping rectangles, the result is minus
/// the length of the shortest translation that separates them. The result is exact to rounding; NaN
/// if a coordinate is NaN.
double Separation(const OrientedBox& a, const OrientedBox& b);

/// Shortest distance between two rectangles [m]; 0 if they touch or overlap.
double Distance(const OrientedBox& a, const OrientedBox& b);

/// Shortest distance from the segment between two points to a rectangle [m]; 0 if the segment
/// touches the rectangle or lies within it. The result is exact to rounding.
double Distance(const Vec2& from, const Vec2& to, const OrientedBox& box);

}  // namespace trackbed
