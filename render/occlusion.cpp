#include "render/occlusion.h"

#include <algorithm>
#include <cmath>

namespace trackbed::render {
namespace {

constexpr double kMargin = 0.5;  // [m]

Eigen::Vector3d Eye(const CameraPose& camera) {
  const double level = camera.distance * std::cos(camera.elevation);
  return {camera.target_x - level * std::cos(camera.azimuth),
          camera.target_y - level * std::sin(camera.azimuth),
          camera.target_z - camera.distance * std::sin(camera.elevation)};
}

/// Whether the segment between two points intersects a box. The two points and the corners of the
/// box are given in the frame of the box.
bool Crosses(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& low,
             const Eigen::Vector3d& high) {
  double enters = 0.0;
  double leaves = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    if (std::abs(way) < 1e-9) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) {
        return false;
      }
      continue;
    }
    const double a = (low[axis] - from[axis]) / way;
    const double b = (high[axis] - from[axis]) / way;
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return enters <= leaves;
}

}  // namespace

double HiddenShare(const UprightBox& box, const CameraPose& camera, const CarBox& car,
                   const Pose2& pose, double ground) {
  const auto in_box = [&](const Eigen::Vector3d& point) {
    const Vec2 flat = ToLocal(box.footprint.center, point.head<2>());
    return Eigen::Vector3d(flat.x(), flat.y(), point.z());
  };
  const Eigen::Vector3d half(0.5 * box.footprint.length + kMargin,
                             0.5 * box.footprint.width + kMargin, 0.0);
  const Eigen::Vector3d low(-half.x(), -half.y(), box.bottom);
  const Eigen::Vector3d high(half.x(), half.y(), box.top + kMargin);
  const Eigen::Vector3d eye = in_box(Eye(camera));
  int crossed = 0;
  int points = 0;
  for (const double along : {-0.9, -0.45, 0.0, 0.45, 0.9}) {
    for (const double across : {-0.8, 0.0, 0.8}) {
      for (const double up : {0.2, 0.8}) {
        const Vec2 flat =
            ToWorld(pose, {car.middle + along * car.half_length, across * car.half_width});
        const Eigen::Vector3d point(flat.x(), flat.y(), ground + up * car.height);
        crossed += Crosses(eye, in_box(point), low, high) ? 1 : 0;
        ++points;
      }
    }
  }
  return static_cast<double>(crossed) / points;
}

double FadedAlpha(double hidden_share) {
  constexpr double kMinAlpha = 0.25;
  // fraction of the car that must be hidden for an obstacle's opacity to reach the minimum
  // kMinAlpha
  constexpr double kAll = 0.3;
  const double part = std::clamp(hidden_share / kAll, 0.0, 1.0);
  return 1.0 - (1.0 - kMinAlpha) * part * part * (3.0 - 2.0 * part);
}

}  // namespace trackbed::render
