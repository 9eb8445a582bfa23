#pragma once

#include <Eigen/Core>

#include "trackbed/sim/scene.h"

struct mjModel_;

namespace trackbed {

/// The point of a tyre that is nearest to the ground or deepest in the ground, in the world frame.
struct TyreTouch {
  Eigen::Vector3d lowest_W;  ///< Lowest point of the tyre, measured along the ground's normal.
  Eigen::Vector3d normal_W;  ///< Unit normal of the ground at the tyre's lowest point.
  /// Distance of the tyre's lowest point from the ground, along the normal [m].
  double gap = 0.0;
};

/// Shape of a tyre: an ellipsoid of revolution about the tyre's y axis, equal to the tyre's geom in
/// MuJoCo.
///
/// The computed contact between tyre and ground is exact if the ground's radius of curvature
/// exceeds the tyre's radius. In a dip whose radius is smaller than the tyre's, a real tyre touches
/// the ground at two points, but the computed contact is a single point.
class TyreShape {
 public:
  TyreShape() = default;
  /// Makes the shape of a tyre from a geom of `model`. A tyre geom other than a sphere or an
  /// ellipsoid is treated as a thin disk.
  TyreShape(const mjModel_& model, int geom);

  /// Returns the point of contact with the ground of a tyre whose center is at `center_W` and whose
  /// orientation is R_WT.
  [[nodiscard]] TyreTouch On(const Ground& ground, const Eigen::Vector3d& center_W,
                             const Eigen::Matrix3d& R_WT) const;

 private:
  // squares of the ellipsoid's half axes in the tyre's frame [m^2]
  Eigen::Vector3d squares_T_ = Eigen::Vector3d::Zero();
};

}  // namespace trackbed
