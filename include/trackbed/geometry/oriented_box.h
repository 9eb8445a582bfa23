#pragma once

#include <array>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A rectangle in the plane, rotated by the yaw of its pose.
struct OrientedBox {
  Pose2 center;         ///< middle of the rectangle; its x axis runs along the length
  double length = 0.0;  ///< along its own x [m], > 0
  double width = 0.0;   ///< along its own y [m], > 0

  /// Counter-clockwise, the first ahead on the left.
  [[nodiscard]] std::array<Vec2, 4> Corners() const;
};

/// A rectangle that moves at constant velocity, without rotation.
struct MovingBox {
  OrientedBox box;          ///< at time 0
  Vec2 velocity{0.0, 0.0};  ///< [m/s]

  /// The rectangle at a time [s].
  [[nodiscard]] OrientedBox At(double time) const;
};

/// Whether a point lies within a rectangle or on its border.
bool Contains(const OrientedBox& box, const Vec2& point);

/// Shortest distance between two rectangles [m]. If they overlap, minus the shortest translation
/// that separates them. Exact to rounding; NaN if a coordinate is NaN.
double Separation(const OrientedBox& a, const OrientedBox& b);

/// Shortest distance between two rectangles [m]; 0 when they touch or overlap.
double Distance(const OrientedBox& a, const OrientedBox& b);

/// Shortest distance from the segment between two points to a rectangle [m]; 0 if they touch or
/// cross, or the segment lies within. Exact to rounding.
double Distance(const Vec2& from, const Vec2& to, const OrientedBox& box);

}  // namespace trackbed
