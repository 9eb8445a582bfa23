#include "render/decor.h"

namespace trackbed::render {

mjvGeom* AddDecor(mjvScene& scene, mjtGeom type, const std::array<mjtNum, 3>& size,
                  const Eigen::Vector3d& center, const RowMajorMatrix3& rotation,
                  const std::array<float, 4>& rgba) {
  if (scene.ngeom >= scene.maxgeom) {
    return nullptr;
  }
  mjvGeom& geom = scene.geoms[scene.ngeom];
  geom = mjvGeom{};
  mjv_initGeom(&geom, type, size.data(), center.data(), rotation.data(), rgba.data());
  geom.category = mjCAT_DECOR;
  geom.specular = 0.0F;
  ++scene.ngeom;
  return &geom;
}

}  // namespace trackbed::render
