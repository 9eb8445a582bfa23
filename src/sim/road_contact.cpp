#include "src/sim/road_contact.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string_view>

#include "src/sim/upright.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A gap this small is none [m]. MuJoCo forgets a contact that opens by a micrometer, as over a
/// crest they do, and a tyre pressed by its spring then falls back on the ground like a hammer.
constexpr double kTouching = 5e-4;
/// What it is taken for then [m]: a contact, but for rounding without depth.
constexpr double kTouch = -1e-9;

bool IsRoad(const mjModel& model, int geom) {
  const char* name = mj_id2name(&model, mjOBJ_GEOM, geom);
  return name != nullptr &&
         (std::string_view(name) == "ground" || std::string_view(name).starts_with("ground_"));
}

Vector3d HalfAxes(const mjModel& model, int geom) {
  const Vector3d size(model.geom_size + 3 * geom);
  // Of what is not round all over, the rim.
  return model.geom_type[geom] == mjGEOM_ELLIPSOID ? size
         : model.geom_type[geom] == mjGEOM_SPHERE  ? Vector3d::Constant(size.x()).eval()
                                                   : Vector3d(size.x(), size.x(), 0.0);
}

/// The bit of contype and conaffinity of what all tyres touch besides their planes; cars have no
/// use for it.
constexpr int kOthersBit = 1 << 28;

}  // namespace

RoadContact::RoadContact(const CarModel& car, mjModel& model)
    : car_(car),
      curved_(!car.scene().ground.bumps.empty() || !car.scene().ground.side_slopes.empty()) {
  if (!curved_) {
    return;
  }
  const std::span<const int> tyres = car.tyres();
  for (std::size_t w = 0; w < tyres.size(); ++w) {
    const int tyre = tyres[w];
    half_axes_T[w] = HalfAxes(model, tyre);
    constexpr std::string_view kTyre = "tyre";
    const std::string_view own_name = mj_id2name(&model, mjOBJ_GEOM, tyre);
    const std::string name = fmt::format("ground{}", own_name.substr(kTyre.size()));
    plane_[w] = mj_name2id(&model, mjOBJ_GEOM, name.c_str());
    TRACKBED_CHECK(plane_[w] >= 0, "the scene has no geom '{}'", name);
    model.geom_sameframe[plane_[w]] = 0;  // else MuJoCo takes its place for the world's origin
    int& contype = model.geom_contype[tyre];
    int& conaffinity = model.geom_conaffinity[tyre];
    for (int geom = 0; geom < model.ngeom; ++geom) {
      if (!IsRoad(model, geom) && ((contype & model.geom_conaffinity[geom]) != 0 ||
                                   (model.geom_contype[geom] & conaffinity) != 0)) {
        model.geom_conaffinity[geom] |= kOthersBit;
      }
    }
    contype = kOthersBit | WheelPlaneBit(w);
    conaffinity = 0;
  }
}

RoadContact::Touch RoadContact::Find(std::size_t wheel, const Vector3d& center_W,
                                     const Matrix3d& R_WT) const {
  const Ground& ground = car_.scene().ground;
  Touch touch;
  Vec2 under = center_W.head<2>();
  double share = 1.0;
  Vec2 last = Vec2::Zero();
  // The ground's normal leans by less than the tyre's lowest point moves on: this contracts by
  // radius times curvature. Where the ground bends down more than that it swings, and is halved.
  for (int i = 0; i < 20; ++i) {
    touch.normal_W = GroundNormal(ground, under);
    const Vector3d squares = half_axes_T[wheel].cwiseProduct(half_axes_T[wheel]);
    const Vector3d normal_T = R_WT.transpose() * touch.normal_W;
    touch.lowest_W = center_W - R_WT * squares.cwiseProduct(normal_T) /
                                    std::sqrt(squares.dot(normal_T.cwiseProduct(normal_T)));
    const Vec2 move = touch.lowest_W.head<2>() - under;
    if (move.norm() < 1e-8) {
      break;
    }
    share = move.dot(last) < 0.0 ? 0.5 * share : share;
    under += share * move;
    last = move;
  }
  const Vector3d ground_W(under.x(), under.y(), GroundHeight(ground, under));
  touch.gap = touch.normal_W.dot(touch.lowest_W - ground_W);
  return touch;
}

void RoadContact::Place(mjModel& model, mjData& data) const {
  if (!curved_) {
    return;
  }
  mj_kinematics(&model, &data);
  const mjtNum* chassis = data.qpos + car_.chassis().chassis_qpos;
  const mjtNum* velocity = data.qvel + car_.chassis().chassis_dof;
  const Vector3d origin_W(chassis);
  const Matrix3d R_WV =
      Eigen::Quaterniond(chassis[3], chassis[4], chassis[5], chassis[6]).toRotationMatrix();
  const Vector3d w_W = R_WV * Vector3d(velocity + 3);
  const std::span<const int> tyres = car_.tyres();
  for (std::size_t w = 0; w < tyres.size(); ++w) {
    const int tyre = tyres[w];
    const Vector3d center_W(data.geom_xpos + 3 * tyre);
    const Matrix3d R_WT =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.geom_xmat + 9 * tyre);
    const double gap = Find(w, center_W, R_WT).gap;
    // The plane leans as the ground does half way through the step: what the tyre then moves along
    // it ends on the ground again, to second order. Its distance is that of the ground now.
    const Vector3d half_way =
        0.5 * model.opt.timestep * (Vector3d(velocity) + w_W.cross(center_W - origin_W));
    const Touch ahead = Find(w, center_W + half_way, R_WT);
    // A tyre with a margin is a spring that reaches beyond its shape: it forgets nothing.
    const bool rigid = model.geom_margin[tyre] == 0.0;
    const double distance = rigid && gap > 0.0 && gap < kTouching ? kTouch : gap;
    const Vector3d position = ahead.lowest_W - half_way - distance * ahead.normal_W;
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
