#pragma once

#include <Eigen/Geometry>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// Returns the orientation R_WB of a body that stands on ground with the slope (dz/dx, dz/dy). The
/// body's z axis is the ground's normal, and its x axis points along `yaw` as seen from above. On
/// flat ground, the returned rotation is exactly that by `yaw` about the z axis.
Eigen::Quaterniond Upright(const Vec2& slope, double yaw);

}  // namespace trackbed
