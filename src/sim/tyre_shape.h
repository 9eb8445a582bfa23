#pragma once

#include <Eigen/Core>

#include "trackbed/sim/scene.h"

struct mjModel_;

namespace trackbed {

/// The point of a tyre that is nearest to the ground or deepest below its surface, in the world
/// frame.
struct TyreTouch {
  Eigen::Vector3d lowest_W;  ///< Lowest point of the tyre along the ground's normal.
  Eigen::Vector3d normal_W;  ///< Normal of the ground.
  double gap = 0.0;          ///< Distance of the lowest point from the ground, along the normal
                             ///< [m].
};

/// Shape of a tyre: an ellipsoid of revolution about the tyre's y axis, which equals the tyre's
/// geom in MuJoCo.
///
/// The computed contact is exact if the ground's radius of curvature exceeds the tyre's radius. In
/// a sharper dip, a real tyre touches the ground at two points, but the computed contact is a
/// single point.
class TyreShape {
 public:
  TyreShape() = default;
  /// Takes the shape of a geom of `model`. A geom other than a sphere or an ellipsoid is treated as
  /// a thin disk.
  TyreShape(const mjModel_& model, int geom);

  /// Returns the contact of the tyre with the ground, if the tyre has this center and the
  /// orientation R_WT.
  [[nodiscard]] TyreTouch On(const Ground& ground, const Eigen::Vector3d& center_W,
                             const Eigen::Matrix3d& R_WT) const;

 private:
  Eigen::Vector3d squares_T_ = Eigen::Vector3d::Zero();  // squares of the half axes [m^2]
};

}  // namespace trackbed
