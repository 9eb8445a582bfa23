#pragma once

#include <Eigen/Core>
#include <optional>

#include "render/camera.h"
#include "render/canvas.h"

namespace trackbed::render {

/// Projects points of the world into a camera's picture.
class Projection {
 public:
  /// Makes the projection for a picture of this size [px].
  Projection(const CameraPose& camera, int width, int height);

  /// The point of the world in the picture; the point may be outside the picture's borders. There
  /// is no point in the picture for points behind the camera or nearer than a tenth of the distance
  /// to its target.
  [[nodiscard]] std::optional<CanvasPoint> operator()(const Eigen::Vector3d& point_W) const;

 private:
  Eigen::Vector3d eye_;
  Eigen::Matrix3d axes_;  // camera axes as rows: right, down, forward
  double nearest_;
  double focal_;  // [px]
  CanvasPoint middle_;
};

}  // namespace trackbed::render
