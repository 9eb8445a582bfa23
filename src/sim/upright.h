#pragma once

#include <Eigen/Geometry>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Orientation R_WB of a body on ground of slope `slope` (dz/dx and dz/dy). The body's z axis is
/// the ground's normal, and its x axis is along `yaw` as seen from above. On flat ground, the
/// orientation is exactly the rotation by `yaw`.
Eigen::Quaterniond Upright(const Vec2& slope, double yaw);

}  // namespace trackbed
