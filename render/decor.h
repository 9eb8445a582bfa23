#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace trackbed::render {

using RowMajorMatrix3 = Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>;

/// Category of shapes that cast shadows. Newer versions of MuJoCo draw mjCAT_DECOR without, as flat
/// paint needs it: its shadows speckle the ground under it.
inline constexpr int kCastsShadow = mjCAT_STATIC;

/// Adds a geom that the model does not have, of mjCAT_DECOR and with `specular` 0, unless the scene
/// is full: then nullptr. Unlike mjv_initGeom it sets every field of mjvGeom.
mjvGeom* AddDecor(mjvScene& scene, mjtGeom type, const std::array<mjtNum, 3>& size,
                  const Eigen::Vector3d& center, const RowMajorMatrix3& rotation,
                  const std::array<float, 4>& rgba);

/// Takes the geoms out of the scene for which `leave_out` is true; the others keep their order.
template <typename Predicate>
void RemoveGeoms(mjvScene& scene, Predicate leave_out) {
  scene.ngeom = static_cast<int>(std::remove_if(scene.geoms, scene.geoms + scene.ngeom, leave_out) -
                                 scene.geoms);
}

}  // namespace trackbed::render
