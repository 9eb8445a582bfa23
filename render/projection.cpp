#include "render/projection.h"

#include <cmath>

namespace trackbed::render {

Projection::Projection(const CameraPose& camera, int width, int height)
    : nearest_(0.1 * camera.distance),
      focal_(0.5 * height / std::tan(0.5 * camera.view_angle)),
      middle_{0.5 * width, 0.5 * height} {
  const double ca = std::cos(camera.azimuth);
  const double sa = std::sin(camera.azimuth);
  const double ce = std::cos(camera.elevation);
  const double se = std::sin(camera.elevation);
  axes_ << sa, -ca, 0.0, se * ca, se * sa, -ce, ce * ca, ce * sa, se;
  eye_ = Eigen::Vector3d(camera.target_x, camera.target_y, camera.target_z) -
         camera.distance * axes_.row(2).transpose();
}

std::optional<CanvasPoint> Projection::operator()(const Eigen::Vector3d& point_W) const {
  const Eigen::Vector3d seen = axes_ * (point_W - eye_);
  if (seen.z() < nearest_) {
    return std::nullopt;
  }
  const double pixels = focal_ / seen.z();
  return CanvasPoint{middle_.x + pixels * seen.x(), middle_.y + pixels * seen.y()};
}

}  // namespace trackbed::render
