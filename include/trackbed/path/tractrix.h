#pragma once

#include "trackbed/geometry/pose.h"

/// The motion of a car's rear axle while a point ahead of the axle moves along a line.
namespace trackbed {

/// Returns the yaw of a car [rad] after the point `ahead` [m] in front of its rear axle has moved
/// straight by the vector `along` [m]. Before the motion, the car's yaw was `yaw`. The rear axle
/// does not slip. `ahead` must not be 0; it is negative for a point behind the rear axle. The
/// returned yaw is exact: while the point moves by the distance d, tan(phi/2) decreases by the
/// factor exp(-d/ahead), where phi is the angle between the yaw and the line.
double YawAlongTractrix(double yaw, const Vec2& along, double ahead);

}  // namespace trackbed
