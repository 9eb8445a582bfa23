#pragma once

#include <Eigen/Core>

#include "trackbed/sim/scene.h"

struct mjModel_;

namespace trackbed {

/// The point of a tyre that is nearest to the ground, or deepest in it, in the world frame.
struct TyreTouch {
  Eigen::Vector3d lowest_W;  ///< The tyre's lowest point along the ground's normal.
  Eigen::Vector3d normal_W;  ///< Normal of the ground.
  double gap = 0.0;          ///< Distance from the ground to the lowest point along the normal [m].
};

/// An ellipsoid about the tyre's axis y. The ellipsoid equals MuJoCo's geom of the tyre.
///
/// The contact is exact if the ground's radius of curvature exceeds the tyre's radius. On ground
/// that curves up more sharply, a real tyre touches at two points, and the ellipsoid at one.
class TyreShape {
 public:
  TyreShape() = default;
  /// Takes the shape of a geom of `model`. For geoms that are not round in all directions, the
  /// shape is that of the rim.
  TyreShape(const mjModel_& model, int geom);

  /// Contact with the ground of a tyre at this center and with this orientation R_WT.
  [[nodiscard]] TyreTouch On(const Ground& ground, const Eigen::Vector3d& center_W,
                             const Eigen::Matrix3d& R_WT) const;

 private:
  Eigen::Vector3d squares_T_ = Eigen::Vector3d::Zero();  // squares of the half axes [m^2]
};

}  // namespace trackbed
