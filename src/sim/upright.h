#pragma once

#include <Eigen/Geometry>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// R_WB of a body that stands on ground of slope `slope` (dz/dx and dz/dy): its z axis is the
/// ground's normal, its x axis is along `yaw` as seen from above. On flat ground exactly the
/// rotation by `yaw`.
Eigen::Quaterniond Upright(const Vec2& slope, double yaw);

}  // namespace trackbed
