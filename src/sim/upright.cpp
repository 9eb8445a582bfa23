#include "src/sim/upright.h"

#include <cmath>

namespace trackbed {

Eigen::Quaterniond Upright(const Vec2& slope, double yaw) {
  const Vec2 ahead = Direction(yaw);
  const double along = slope.dot(ahead);
  const double across = slope.dot(LeftNormal(ahead));
  const Eigen::Quaterniond turn(std::cos(0.5 * yaw), 0.0, 0.0, std::sin(0.5 * yaw));
  Eigen::Matrix3d lean;
  lean.col(0) = Eigen::Vector3d(1.0, 0.0, along).normalized();
  lean.col(2) = Eigen::Vector3d(-along, -across, 1.0).normalized();
  lean.col(1) = lean.col(2).cross(lean.col(0));
  return turn * Eigen::Quaterniond(lean);
}

}  // namespace trackbed
