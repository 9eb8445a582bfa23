#pragma once

#include <Eigen/Core>
#include <optional>

#include "render/camera.h"
#include "render/canvas.h"

namespace trackbed::render {

/// Projects points of the world into a camera's picture.
class Projection {
 public:
  /// For a picture of this size [px].
  Projection(const CameraPose& camera, int width, int height);

  /// The point in the picture, which may lie outside its borders. None for points behind the camera
  /// or nearer than a tenth of the distance to its target.
  [[nodiscard]] std::optional<CanvasPoint> operator()(const Eigen::Vector3d& point_W) const;

 private:
  Eigen::Vector3d eye_;
  Eigen::Matrix3d axes_;  // rows: right, down, forward
  double nearest_;
  double focal_;  // [px]
  CanvasPoint middle_;
};

}  // namespace trackbed::render
