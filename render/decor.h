#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>

namespace trackbed::render {

using RowMajorMatrix3 = Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>;

/// Adds a geom that the model does not have, with `specular` 0, unless the scene is full: then
/// nullptr. Unlike mjv_initGeom it sets every field of mjvGeom.
mjvGeom* AddDecor(mjvScene& scene, mjtGeom type, const std::array<mjtNum, 3>& size,
                  const Eigen::Vector3d& center, const RowMajorMatrix3& rotation,
                  const std::array<float, 4>& rgba);

}  // namespace trackbed::render
