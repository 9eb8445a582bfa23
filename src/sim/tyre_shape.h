#pragma once

#include <Eigen/Core>

#include "trackbed/sim/scene.h"

struct mjModel_;

namespace trackbed {

/// Point of a tyre nearest to the ground, or deepest in it; world frame.
struct TyreTouch {
  Eigen::Vector3d lowest_W;  ///< the tyre's lowest point along the ground's normal
  Eigen::Vector3d normal_W;  ///< of the ground
  double gap = 0.0;          ///< from the ground to that point along the normal [m]
};

/// An ellipsoid about the tyre's axis, y, equal to MuJoCo's geom of the tyre.
///
/// Exact if the radius of the ground's curvature exceeds the tyre's. On ground that curves up more
/// sharply a real tyre touches at two points, this one at one.
class TyreShape {
 public:
  TyreShape() = default;
  /// Shape of a geom of `model`; for geoms that are not round in all directions, the rim.
  TyreShape(const mjModel_& model, int geom);

  /// Contact with the ground of a tyre at this center and orientation R_WT.
  [[nodiscard]] TyreTouch On(const Ground& ground, const Eigen::Vector3d& center_W,
                             const Eigen::Matrix3d& R_WT) const;

 private:
  Eigen::Vector3d squares_T_ = Eigen::Vector3d::Zero();  // of the half axes [m^2]
};

}  // namespace trackbed
