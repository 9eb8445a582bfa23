#include "trackbed/sim/car_model.h"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "src/sim/car_parts.h"
#include "src/sim/model_check.h"
#include "src/sim/trailer_parts.h"
#include "src/sim/upright.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/compile_scene.h"
#include "trackbed/sim/mujoco_error.h"

namespace trackbed {
namespace {

/// Returns the parameters that the car would have without the mass of its payload.
VehicleParams Unladen(const mjModel& laden, int payload, const std::string& name) {
  const MujocoModel model = CopyMujocoModel(laden);
  const MujocoData data = MakeMujocoData(*model);
  model->body_mass[payload] = 0.0;
  mj_setConst(model.get(), data.get());
  return DescribeVehicle(*model, name).params;
}

/// Height and orientation of the vehicle frame V of a car that stands on the ground.
struct Stand {
  double height = 0.0;  ///< [m]
  Eigen::Quaterniond turn;
};

Stand RestPoseOn(const VehicleParams& params, const Pose2& pose, const Ground& ground) {
  // The ground's height is sampled at the positions that the wheels would have on level ground. On
  // a slope, the wheels are horizontally closer together than on level ground, but only by a
  // second-order term, which is neglected.
  const bool steered = params.kind == VehicleKind::kSteered;
  const double ahead_of_axle = steered ? params.wheelbase : params.length - params.rear_overhang;
  const double track_front = steered ? params.track_front : params.width;
  const double front = 0.5 * track_front;
  const double rear = 0.5 * params.track_rear;
  const std::array<Vec2, 4> wheels{
      {{ahead_of_axle, front}, {ahead_of_axle, -front}, {0.0, rear}, {0.0, -rear}}};
  std::array<double, 4> z{};
  for (std::size_t w = 0; w < z.size(); ++w) {
    z[w] = GroundHeight(ground, ToWorld(pose, wheels[w]));
  }
  const Vec2 slope((z[0] + z[1] - z[2] - z[3]) / (2.0 * ahead_of_axle),
                   0.5 * ((z[0] - z[1]) / track_front + (z[2] - z[3]) / params.track_rear));
  double height = 0.5 * (z[2] + z[3]);
  double deepest = 0.0;
  for (std::size_t w = 0; w < z.size(); ++w) {
    deepest = std::max(deepest, z[w] - height - slope.dot(wheels[w]));
  }
  const Vec2 ahead = Direction(pose.yaw);
  return {height + deepest, Upright(slope.x() * ahead + slope.y() * LeftNormal(ahead), pose.yaw)};
}

/// Returns yaw, pitch and roll of a trailer relative to its car, such that both wheels of the
/// trailer touch the ground. The argument `stand` contains the height and orientation of the car.
/// The ground's height is sampled at the positions that the wheels would have on level ground.
std::array<double, 3> RestingHitch(const TrailerParts& trailer, const Pose2& car, double angle,
                                   const Stand& stand, const Ground& ground) {
  if (IsFlat(ground)) {
    return {angle, 0.0, 0.0};
  }
  const TrailerParams& params = trailer.params;
  const Pose2 axle = TrailerPose(params, car, angle);
  const Eigen::Vector3d hitch =
      stand.turn * Eigen::Vector3d(-params.hitch, 0.0, params.hitch_height);
  const double left = GroundHeight(ground, ToWorld(axle, {0.0, 0.5 * params.track}));
  const double right = GroundHeight(ground, ToWorld(axle, {0.0, -0.5 * params.track}));
  // At the trailer axle, the ground is below the hitch by hitch_height minus tongue times the
  // pitch; the pitch is positive for a lowered nose.
  const double below = stand.height + hitch.z() - 0.5 * (left + right);
  const double pitch = (params.hitch_height - below) / params.tongue;
  const double roll = (left - right) / params.track;
  const Eigen::Quaterniond wanted = Eigen::AngleAxisd(axle.yaw, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  const Eigen::Matrix3d relative = (stand.turn.conjugate() * wanted).toRotationMatrix();
  const double yaw = std::atan2(relative(1, 0), relative(0, 0));
  return {angle + AngleDifference(yaw, angle), -std::asin(relative(2, 0)),
          std::atan2(relative(2, 1), relative(2, 2))};
}

}  // namespace

CarModel::CarModel(Scene scene, std::string name_for_messages)
    : scene_(std::move(scene)),
      file_(std::move(name_for_messages)),
      model_(CompileScene(scene_, file_, Looks::kDiscarded)) {
  const MujocoErrorScope errors;
  CheckModel(*model_, file_);
  const VehicleDescription car = DescribeVehicle(*model_, file_);
  parts_ = car.parts;
  params_ = car.params;
  trailer_ = FindTrailer(*model_);
  laden_keyframe_ = mj_name2id(model_.get(), mjOBJ_KEY, kLadenKeyframe);
  const int payload = mj_name2id(model_.get(), mjOBJ_BODY, kPayloadBody);
  unladen_ = payload >= 0 ? Unladen(*model_, payload, file_) : params_;
}

CarModel::CarModel(CarModel&&) noexcept = default;
CarModel& CarModel::operator=(CarModel&&) noexcept = default;
CarModel::~CarModel() = default;

const ChassisParts& CarModel::chassis() const {
  return std::visit([](const ChassisParts& parts) -> const ChassisParts& { return parts; }, parts_);
}

const CarParts& CarModel::parts() const {
  TRACKBED_CHECK(params_.kind == VehicleKind::kSteered, "{} has no steered wheels", params_.name);
  return std::get<CarParts>(parts_);
}

const WheelPairParts& CarModel::wheel_pair() const {
  TRACKBED_CHECK(params_.kind == VehicleKind::kDifferential, "{} has steered wheels", params_.name);
  return std::get<WheelPairParts>(parts_);
}

std::span<const int> CarModel::tyres() const {
  return std::visit([](const auto& parts) { return std::span<const int>(parts.tyre); }, parts_);
}

std::span<const int> CarModel::wheels() const {
  return std::visit([](const auto& parts) { return std::span<const int>(parts.wheel); }, parts_);
}

double CarModel::timestep() const {
  return model_->opt.timestep;
}

std::vector<std::string> CarModel::configuration_columns() const {
  std::vector<std::string> columns{"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"};
  for (int joint = 0; joint < model_->njnt; ++joint) {
    const int type = model_->jnt_type[joint];
    if (type == mjJNT_HINGE || type == mjJNT_SLIDE) {
      const char* name = mj_id2name(model_.get(), mjOBJ_JOINT, joint);
      columns.push_back(fmt::format("{}_{}", name == nullptr ? fmt::format("joint{}", joint) : name,
                                    type == mjJNT_HINGE ? "rad" : "m"));
    }
  }
  return columns;
}

std::vector<double> CarModel::ExtractConfiguration(std::span<const double> qpos) const {
  const auto place = qpos.subspan(static_cast<std::size_t>(chassis().chassis_qpos), 7);
  std::vector<double> values;
  values.reserve(place.size() + static_cast<std::size_t>(model_->njnt));
  values.assign(place.begin(), place.end());
  for (int joint = 0; joint < model_->njnt; ++joint) {
    const int type = model_->jnt_type[joint];
    if (type == mjJNT_HINGE || type == mjJNT_SLIDE) {
      values.push_back(qpos[static_cast<std::size_t>(model_->jnt_qposadr[joint])]);
    }
  }
  return values;
}

std::vector<double> CarModel::StandingPosition(const Pose2& pose, double steering,
                                               const std::vector<double>& spin,
                                               const Ground& ground, double hitch_angle) const {
  const Stand stand = RestPoseOn(params_, pose, ground);
  const bool laden = laden_keyframe_ >= 0;
  const mjtNum* level = laden ? model_->key_qpos + laden_keyframe_ * model_->nq : model_->qpos0;
  std::vector<double> qpos(level, level + model_->nq);
  const auto set = [&](int address, double value) {
    qpos[static_cast<std::size_t>(address)] = value;
  };
  const int chassis_qpos = chassis().chassis_qpos;
  set(chassis_qpos, pose.x);
  set(chassis_qpos + 1, pose.y);
  // height of the chassis above the ground, along the ground's normal
  const mjtNum sag = level[chassis_qpos + 2];
  const double upright = laden ? (stand.turn * Eigen::Vector3d::UnitZ()).z() : 1.0;
  set(chassis_qpos + 2, sag / upright + stand.height);
  const mjtNum* lean = level + chassis_qpos + 3;
  const Eigen::Quaterniond turn =
      laden ? stand.turn * Eigen::Quaterniond(lean[0], lean[1], lean[2], lean[3]) : stand.turn;
  set(chassis_qpos + 3, turn.w());
  set(chassis_qpos + 4, turn.x());
  set(chassis_qpos + 5, turn.y());
  set(chassis_qpos + 6, turn.z());
  const auto roll = [&](std::span<const int> wheels) {
    TRACKBED_CHECK(spin.empty() || spin.size() == wheels.size(), "{} angles for {} wheels",
                   spin.size(), wheels.size());
    for (std::size_t w = 0; w < wheels.size(); ++w) {
      set(wheels[w], spin.empty() ? 0.0 : spin[w]);
    }
  };
  if (trailer_) {
    const auto angles = RestingHitch(*trailer_, pose, hitch_angle, {stand.height, turn}, ground);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      set(trailer_->hitch_qpos[i], angles[i]);
    }
  }
  if (params_.kind == VehicleKind::kDifferential) {
    roll(wheel_pair().spin_qpos);
    return qpos;
  }
  roll(parts().spin_qpos);
  const FrontAngles front = AckermannAngles(params_, steering);
  set(parts().steer_qpos[0], front.left);
  set(parts().steer_qpos[1], front.right);
  set(parts().rack_qpos, steering);
  return qpos;
}

Eigen::Vector3d CarModel::AheadOnGround(const Pose2& pose, const Ground& ground) const {
  return RestPoseOn(params_, pose, ground).turn.normalized().toRotationMatrix().col(0);
}

std::vector<double> CarModel::FlatConfiguration(const Pose2& pose, double steering,
                                                const std::vector<double>& spin,
                                                double hitch_angle) const {
  return ExtractConfiguration(StandingPosition(pose, steering, spin, scene_.ground, hitch_angle));
}

std::vector<double> CarModel::FlatPosition(const Pose2& pose, double steering,
                                           const std::vector<double>& spin) const {
  return StandingPosition(pose, steering, spin, {});
}

WheelSpeeds RollingSpeeds(const VehicleParams& params, double speed, double steering) {
  const AxleSpeeds rear = AxleSpeedsFor(params, speed, steering);
  if (params.kind == VehicleKind::kDifferential) {
    return WheelSpeeds{{rear.left, rear.right}};
  }
  const double yaw_rate = speed * CurvatureForSteering(params, steering);
  // With Ackermann angles, each front wheel points along the velocity of its hub.
  const auto front_speed = [&](double y) {
    return std::copysign(std::hypot(speed - yaw_rate * y, yaw_rate * params.wheelbase), speed);
  };
  return WheelSpeeds{{front_speed(0.5 * params.track_front), front_speed(-0.5 * params.track_front),
                      rear.left, rear.right}};
}

std::string PhysicsVersion() {
  TRACKBED_CHECK(mj_version() == mjVERSION_HEADER, "MuJoCo {} is loaded, built with headers of {}",
                 mj_version(), mjVERSION_HEADER);
  return fmt::format("MuJoCo {}", mj_versionString());
}

}  // namespace trackbed
