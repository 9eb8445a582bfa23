#pragma once

#include <array>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A rectangle in the plane, whose orientation is the yaw of `pose`.
struct OrientedBox {
  /// Pose of the middle of the rectangle; the x axis of this pose runs along the length.
  Pose2 center;
  double length = 0.0;  ///< Extent of the rectangle along its own x axis [m], > 0.
  double width = 0.0;   ///< Extent of the rectangle along its own y axis [m], > 0.

  /// Returns the four corners of the rectangle in counter-clockwise order, starting with the front
  /// left corner.
  [[nodiscard]] std::array<Vec2, 4> Corners() const;
};

/// A rectangle that moves at constant velocity and does not rotate.
struct MovingBox {
  OrientedBox box;          ///< The moving rectangle at time 0.
  Vec2 velocity{0.0, 0.0};  ///< Velocity [m/s].

  /// Returns the moving rectangle at the given time [s].
  [[nodiscard]] OrientedBox At(double time) const;
};

/// Whether the point lies within the rectangle or on the rectangle's border.
bool Contains(const OrientedBox& box, const Vec2& point);

/// Returns the shortest distance between two rectangles [m], exact except for rounding errors. If
/// the rectangles overlap, returns minus the length of the shortest translation that separates the
/// rectangles. Returns NaN if a coordinate is NaN.
double Separation(const OrientedBox& a, const OrientedBox& b);

/// Returns the shortest distance between two rectangles [m]; 0 if the rectangles touch or overlap.
double Distance(const OrientedBox& a, const OrientedBox& b);

/// Returns the shortest distance from the line segment between two points to a rectangle [m], exact
/// except for rounding errors. Returns 0 if the segment touches the rectangle or lies inside the
/// rectangle.
double Distance(const Vec2& from, const Vec2& to, const OrientedBox& box);

}  // namespace trackbed
