#include "render/cone.h"

#include <array>

#include "render/decor.h"

namespace trackbed::render {

void AddCone(mjvScene& scene, const Point& foot) {
  // Radii of the cylinders that form a cone [m], from bottom to top.
  constexpr std::array<double, kConePieces> kRadii{0.15, 0.11, 0.08, 0.05};
  // Half the height of each cylinder of a cone [m].
  constexpr double kHalf = 0.0625;
  constexpr std::array<float, 4> kOrange{0.95F, 0.35F, 0.05F, 1.0F};
  constexpr std::array<float, 4> kWhite{0.95F, 0.95F, 0.95F, 1.0F};
  for (std::size_t i = 0; i < kConePieces; ++i) {
    const double middle = kHalf * (2.0 * static_cast<double>(i) + 1.0);
    if (mjvGeom* piece = AddDecor(scene, mjGEOM_CYLINDER, {kRadii[i], kHalf, 0.0},
                                  {foot.x, foot.y, foot.z + middle}, RowMajorMatrix3::Identity(),
                                  i == 2 ? kWhite : kOrange)) {
      piece->specular = 0.5F;
      piece->category = kCastsShadow;
    }
  }
}

}  // namespace trackbed::render
