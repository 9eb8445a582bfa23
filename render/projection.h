#pragma once

#include <Eigen/Core>
#include <optional>

#include "render/camera.h"
#include "render/canvas.h"

namespace trackbed::render {

/// Projects points of the world into the image of a camera.
class Projection {
 public:
  /// Makes the projection into an image with the given width and height [px].
  Projection(const CameraPose& camera, int width, int height);

  /// Projects a point of the world into the image; the result may be outside the image's borders.
  /// Returns nullopt for a point that is behind the camera, or closer to the camera than a tenth of
  /// the distance to the camera's target.
  [[nodiscard]] std::optional<CanvasPoint> operator()(const Eigen::Vector3d& point_W) const;

 private:
  Eigen::Vector3d eye_;
  Eigen::Matrix3d axes_;  // rotation matrix whose rows are the camera axes: right, down, forward
  double nearest_;
  double focal_;  // [px]
  CanvasPoint middle_;
};

}  // namespace trackbed::render
