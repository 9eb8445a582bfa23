#pragma once

#include <array>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// A rectangle in the plane, turned by its pose's yaw.
struct OrientedBox {
  Pose2 centre;         ///< middle of the rectangle; its x axis runs along the length
  double length = 0.0;  ///< along its own x [m], > 0
  double width = 0.0;   ///< along its own y [m], > 0

  /// Counter-clockwise, the first ahead on the left.
  [[nodiscard]] std::array<Vec2, 4> Corners() const;
};

/// Shortest distance between two rectangles [m]; 0 when they touch or overlap. Exact to rounding,
/// both outside and where one lies within the other (Boost.Geometry).
double Distance(const OrientedBox& a, const OrientedBox& b);

}  // namespace trackbed
