#pragma once

#include <Eigen/Core>

#include "trackbed/sim/scene.h"

struct mjModel_;

namespace trackbed {

/// Where a tyre is nearest to the ground, or deepest in it; world frame.
struct TyreTouch {
  Eigen::Vector3d lowest_W;  ///< the point of the tyre farthest against the ground's normal
  Eigen::Vector3d normal_W;  ///< of the ground
  double gap = 0.0;          ///< from the ground to that point along the normal [m]
};

/// An ellipsoid about the tyre's axis, y, as MuJoCo's geom of the tyre.
///
/// Its touch is exact for ground that bends less than a tyre does; where it bends up more, a real
/// tyre touches at two places, this one at one.
class TyreShape {
 public:
  TyreShape() = default;
  /// That of a geom of `model`; of what is not round all over, the rim.
  TyreShape(const mjModel_& model, int geom);

  /// With its center and orientation R_WT.
  [[nodiscard]] TyreTouch On(const Ground& ground, const Eigen::Vector3d& center_W,
                             const Eigen::Matrix3d& R_WT) const;

 private:
  Eigen::Vector3d squares_T_ = Eigen::Vector3d::Zero();  // of the half axes [m^2]
};

}  // namespace trackbed
