#include "render/cone.h"

#include <array>

namespace trackbed::render {

void AddCone(mjvScene& scene, const Point& foot) {
  // Cylinders, from bottom to top.
  constexpr std::array<double, kConePieces> kRadii{0.15, 0.11, 0.08, 0.05};  // [m]
  constexpr double kHalf = 0.0625;                                           // of a height [m]
  constexpr std::array<float, 4> kOrange{0.95F, 0.35F, 0.05F, 1.0F};
  constexpr std::array<float, 4> kWhite{0.95F, 0.95F, 0.95F, 1.0F};
  for (std::size_t i = 0; i < kConePieces && scene.ngeom < scene.maxgeom; ++i) {
    const std::array<mjtNum, 3> size{kRadii[i], kHalf, 0.0};
    const double middle = kHalf * (2.0 * static_cast<double>(i) + 1.0);
    const std::array<mjtNum, 3> place{foot.x, foot.y, foot.z + middle};
    mjvGeom& geom = scene.geoms[scene.ngeom];
    mjv_initGeom(&geom, mjGEOM_CYLINDER, size.data(), place.data(), nullptr,
                 i == 2 ? kWhite.data() : kOrange.data());
    geom.category = mjCAT_DECOR;
    ++scene.ngeom;
  }
}

}  // namespace trackbed::render
