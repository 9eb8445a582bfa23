#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace trackbed::render {

using RowMajorMatrix3 = Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>;

/// MuJoCo's category for added shapes that cast shadows. In newer versions of MuJoCo, shapes of the
/// category mjCAT_DECOR cast no shadows. Flat paint on the ground has the category mjCAT_DECOR,
/// because its shadows would speckle the ground below.
inline constexpr int kCastsShadow = mjCAT_STATIC;

/// Adds a geom that is not part of the model to the scene, with category mjCAT_DECOR and `specular`
/// 0. AddDecor returns nullptr if the scene is full. Unlike mjv_initGeom, AddDecor sets every field
/// of mjvGeom.
mjvGeom* AddDecor(mjvScene& scene, mjtGeom type, const std::array<mjtNum, 3>& size,
                  const Eigen::Vector3d& center, const RowMajorMatrix3& rotation,
                  const std::array<float, 4>& rgba);

/// Removes from the scene all geoms for which `leave_out` returns true. RemoveGeoms keeps the order
/// of the remaining geoms.
template <typename Predicate>
void RemoveGeoms(mjvScene& scene, Predicate leave_out) {
  scene.ngeom = static_cast<int>(std::remove_if(scene.geoms, scene.geoms + scene.ngeom, leave_out) -
                                 scene.geoms);
}

}  // namespace trackbed::render
