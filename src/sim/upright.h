#pragma once

#include <Eigen/Geometry>

#include "trackbed/geometry/pose.h"

namespace trackbed {

/// R_WB of what stands on ground of slope `slope` (dz/dx and dz/dy): its z axis along the ground's
/// normal, its x axis along `yaw` as seen from above. On flat ground the turn by `yaw`, exactly.
Eigen::Quaterniond Upright(const Vec2& slope, double yaw);

}  // namespace trackbed
