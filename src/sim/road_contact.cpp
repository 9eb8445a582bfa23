#include "src/sim/road_contact.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "src/sim/upright.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Gap between tyre and ground up to which the tyre is still treated as touching [m]. At a crest,
/// gaps of about a micrometer open under the tyre. Without this tolerance, MuJoCo would drop the
/// contact at a micrometer gap, and the suspension spring would hammer the tyre back onto the
/// ground.
constexpr double kContactGap = 5e-4;
/// Distance between tyre and plane that replaces a small gap [m]; negative, that is, a penetration
/// as small as a rounding error.
constexpr double kContactDistance = -1e-9;

bool IsRoad(const mjModel& model, int geom) {
  const char* name = mj_id2name(&model, mjOBJ_GEOM, geom);
  return name != nullptr &&
         (std::string_view(name) == "ground" || std::string_view(name).starts_with("ground_"));
}

/// Collision bit (contype, conaffinity) of all geoms that the tyres can touch, except the planes
/// under the tyres. The models of cars must not use the collision bit kOtherGeomsBit.
constexpr int kOtherGeomsBit = 1 << 28;

}  // namespace

RoadContact::RoadContact(const CarModel& car, TyreSupport support, mjModel& model)
    : car_(car),
      has_planes_(support == TyreSupport::kContacts && !IsPlane(car.scene().ground)),
      tyres_(car.tyres().begin(), car.tyres().end()) {
  if (car.trailer()) {
    tyres_.insert(tyres_.end(), car.trailer()->tyre.begin(), car.trailer()->tyre.end());
  }
  if (support == TyreSupport::kContacts && !has_planes_) {
    return;
  }
  const std::size_t of_car = car.tyres().size();
  const std::vector<int>& tyres = tyres_;
  for (std::size_t i = 0; i < tyres.size(); ++i) {
    // The trailer's wheels always have the indices 4 and 5, even if the vehicle has two wheels.
    const std::size_t w = i < of_car ? i : 4 + i - of_car;
    const int tyre = tyres[i];
    if (has_planes_) {
      shape_[i] = TyreShape(model, tyre);
      constexpr std::string_view kTyre = "tyre";
      const std::string_view own_name = mj_id2name(&model, mjOBJ_GEOM, tyre);
      const std::string name = fmt::format("ground{}", own_name.substr(kTyre.size()));
      plane_[i] = mj_name2id(&model, mjOBJ_GEOM, name.c_str());
      TRACKBED_CHECK(plane_[i] >= 0, "the scene has no geom '{}'", name);
      // without resetting geom_sameframe, MuJoCo would leave the plane at the world's origin
      model.geom_sameframe[plane_[i]] = 0;
    }
    int& contype = model.geom_contype[tyre];
    int& conaffinity = model.geom_conaffinity[tyre];
    for (int geom = 0; geom < model.ngeom; ++geom) {
      const bool is_tyre = std::find(tyres.begin(), tyres.end(), geom) != tyres.end();
      if (!is_tyre && !IsRoad(model, geom) &&
          ((contype & model.geom_conaffinity[geom]) != 0 ||
           (model.geom_contype[geom] & conaffinity) != 0)) {
        model.geom_conaffinity[geom] |= kOtherGeomsBit;
      }
    }
    contype = has_planes_ ? kOtherGeomsBit | WheelPlaneBit(w) : kOtherGeomsBit;
    conaffinity = 0;
  }
}

void RoadContact::Place(mjModel& model, mjData& data) const {
  if (!has_planes_) {
    return;
  }
  mj_kinematics(&model, &data);
  const Ground& ground = car_.scene().ground;
  const mjtNum* chassis = data.qpos + car_.chassis().chassis_qpos;
  const mjtNum* velocity = data.qvel + car_.chassis().chassis_dof;
  const Vector3d origin_W(chassis);
  const Matrix3d R_WV =
      Eigen::Quaterniond(chassis[3], chassis[4], chassis[5], chassis[6]).toRotationMatrix();
  const Vector3d w_W = R_WV * Vector3d(velocity + 3);
  for (std::size_t w = 0; w < tyres_.size(); ++w) {
    const int tyre = tyres_[w];
    const Vector3d center_W(data.geom_xpos + 3 * tyre);
    const Matrix3d R_WT =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.geom_xmat + 9 * tyre);
    const double gap = shape_[w].On(ground, center_W, R_WT).gap;
    // The plane under a tyre gets the slope that the ground has at the middle of the step. A tyre
    // that moves along its plane ends the step on the ground, up to second-order errors. The plane
    // is placed such that its distance from the tyre equals the present distance between tyre and
    // ground.
    const Vector3d half_step_motion =
        0.5 * model.opt.timestep * (Vector3d(velocity) + w_W.cross(center_W - origin_W));
    const TyreTouch ahead = shape_[w].On(ground, center_W + half_step_motion, R_WT);
    const double distance = gap > 0.0 && gap < kContactGap ? kContactDistance : gap;
    const Vector3d position = ahead.lowest_W - half_step_motion - distance * ahead.normal_W;
    const Vec2 slope = -ahead.normal_W.head<2>() / ahead.normal_W.z();
    const Eigen::Quaterniond turn = Upright(slope, 0.0);
    mjtNum* place = model.geom_pos + 3 * plane_[w];
    Eigen::Map<Vector3d>{place} = position;
    mjtNum* quat = model.geom_quat + 4 * plane_[w];
    quat[0] = turn.w();
    quat[1] = turn.x();
    quat[2] = turn.y();
    quat[3] = turn.z();
  }
}

}  // namespace trackbed
