#include "src/sim/tyre_shape.h"

#include <mujoco/mujoco.h>

#include <cmath>

namespace trackbed {
namespace {

using Eigen::Vector3d;

Vector3d HalfAxes(const mjModel& model, int geom) {
  const Vector3d size(model.geom_size + 3 * geom);
  return model.geom_type[geom] == mjGEOM_ELLIPSOID ? size
         : model.geom_type[geom] == mjGEOM_SPHERE  ? Vector3d::Constant(size.x()).eval()
                                                   : Vector3d(size.x(), size.x(), 0.0);
}

}  // namespace

TyreShape::TyreShape(const mjModel& model, int geom)
    : squares_T_(HalfAxes(model, geom).cwiseAbs2()) {}

TyreTouch TyreShape::On(const Ground& ground, const Vector3d& center_W,
                        const Eigen::Matrix3d& R_WT) const {
  TyreTouch touch;
  Vec2 under = center_W.head<2>();
  double share = 1.0;
  Vec2 last = Vec2::Zero();
  // Finds the lowest point of the tyre by fixed-point iteration. Each iteration multiplies the
  // error of the lowest point by the ratio of the tyre's radius to the ground's radius of
  // curvature. On a crest whose radius is smaller than that of the tyre, the iteration would
  // oscillate, so its step is halved.
  for (int i = 0; i < 20; ++i) {
    touch.normal_W = GroundNormal(ground, under);
    const Vector3d normal_T = R_WT.transpose() * touch.normal_W;
    touch.lowest_W = center_W - R_WT * squares_T_.cwiseProduct(normal_T) /
                                    std::sqrt(squares_T_.dot(normal_T.cwiseAbs2()));
    const Vec2 move = touch.lowest_W.head<2>() - under;
    if (move.squaredNorm() < 1e-16) {
      break;
    }
    share = move.dot(last) < 0.0 ? 0.5 * share : share;
    under += share * move;
    last = move;
    if (IsPlane(ground)) {
      break;  // the ground's normal no longer changes between iterations
    }
  }
  const Vector3d ground_W(under.x(), under.y(), GroundHeight(ground, under));
  touch.gap = touch.normal_W.dot(touch.lowest_W - ground_W);
  return touch;
}

}  // namespace trackbed
