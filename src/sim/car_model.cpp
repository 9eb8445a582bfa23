#include "trackbed/sim/car_model.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "src/sim/mujoco_error.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

struct VfsDeleter {
  void operator()(mjVFS* vfs) const {
    mj_deleteVFS(vfs);
    delete vfs;
  }
};

struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

mjModel* Compile(const Scene& scene, const std::string& name) {
  TameMujoco();
  static_cast<void>(PhysicsVersion());
  const std::unique_ptr<mjVFS, VfsDeleter> vfs(new mjVFS);  // too large for the stack
  mj_defaultVFS(vfs.get());
  const auto add = [&](const std::string& file, const std::string& content) {
    const int status =
        mj_makeEmptyFileVFS(vfs.get(), file.c_str(), static_cast<int>(content.size()));
    TRACKBED_CHECK(status == 0, "cannot hand {} to MuJoCo", file);
    const int slot = mj_findFileVFS(vfs.get(), file.c_str());
    std::memcpy(vfs->filedata[slot], content.data(), content.size());
  };
  add("model.xml", scene.xml);
  for (const SceneAsset& asset : scene.assets) {
    add(asset.name, asset.content);
  }
  std::array<char, 1000> message{};
  mjModel* model = nullptr;
  try {
    model = mj_loadXML("model.xml", vfs.get(), message.data(), static_cast<int>(message.size()));
  } catch (const RunError& error) {
    throw InputError(Problem{.file = name, .message = error.what()});
  }
  if (model == nullptr) {
    throw InputError(
        Problem{.file = name, .message = fmt::format("does not compile: {}", message.data())});
  }
  return model;
}

/// Looks names up and remembers every one that is missing.
class Finder {
 public:
  Finder(const mjModel& model, std::string file) : model_(model), file_(std::move(file)) {}

  int Find(int type, const char* kind, const std::string& name) {
    const int id = mj_name2id(&model_, type, name.c_str());
    if (id < 0) {
      Complain(name, fmt::format("the model has no {} of this name", kind));
    }
    return id;
  }

  int Joint(const std::string& name, int type, const char* kind) {
    const int id = Find(mjOBJ_JOINT, kind, name);
    if (id >= 0 && model_.jnt_type[id] != type) {
      Complain(name, fmt::format("must be a {}", kind));
      return -1;
    }
    return id;
  }

  double Number(const std::string& name) {
    const int id = Find(mjOBJ_NUMERIC, "<custom><numeric>", name);
    return id < 0 ? 0.0 : model_.numeric_data[model_.numeric_adr[id]];
  }

  void Complain(std::string name, std::string message) {
    problems_.push_back({file_, 0, 0, std::move(name), std::move(message)});
  }

  void ThrowIfAnything() const {
    if (!problems_.empty()) {
      throw InputError(problems_);
    }
  }

 private:
  const mjModel& model_;
  std::string file_;
  std::vector<Problem> problems_;
};

CarParts FindParts(const mjModel& m, Finder& find) {
  CarParts parts;
  parts.chassis = find.Find(mjOBJ_BODY, "body", "chassis");
  const int chassis = find.Joint("chassis", mjJNT_FREE, "free joint");
  const int rack = find.Joint("rack", mjJNT_HINGE, "hinge joint");
  find.Find(mjOBJ_GEOM, "geom", "ground");
  std::array<int, 4> spin{};
  std::array<int, 2> steer{};
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const std::string wheel = kWheels[w];
    parts.tyre[w] = find.Find(mjOBJ_GEOM, "geom", "tyre_" + wheel);
    spin[w] = find.Joint("spin_" + wheel, mjJNT_HINGE, "hinge joint");
    if (w < 2) {
      steer[w] = find.Joint("steer_" + wheel, mjJNT_HINGE, "hinge joint");
    }
  }
  parts.steer_actuator = find.Find(mjOBJ_ACTUATOR, "actuator", "steer");
  parts.drive_actuator = find.Find(mjOBJ_ACTUATOR, "actuator", "drive");
  parts.brake_torque_front = find.Number("brake_torque_front");
  parts.brake_torque_rear = find.Number("brake_torque_rear");
  find.ThrowIfAnything();

  parts.chassis_qpos = m.jnt_qposadr[chassis];
  parts.chassis_dof = m.jnt_dofadr[chassis];
  parts.rack_qpos = m.jnt_qposadr[rack];
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    parts.spin_qpos[w] = m.jnt_qposadr[spin[w]];
    parts.spin_dof[w] = m.jnt_dofadr[spin[w]];
    parts.wheel[w] = m.jnt_bodyid[spin[w]];
    parts.carrier[w] = m.body_parentid[parts.wheel[w]];
    // About the spin axis, which is the wheel body's y axis when its inertia is given in place.
    const mjtNum* inertia = m.body_inertia + 3 * parts.wheel[w];
    parts.spin_inertia[w] = *std::max_element(inertia, inertia + 3);
  }
  for (std::size_t w = 0; w < 2; ++w) {
    parts.steer_qpos[w] = m.jnt_qposadr[steer[w]];
  }
  const int steering = parts.steer_actuator;
  parts.steer_state = steering - (m.nu - m.na);  // stateful actuators come last
  if (m.actuator_dyntype[steering] != mjDYN_INTEGRATOR || !m.actuator_ctrllimited[steering] ||
      !m.actuator_actlimited[steering]) {
    find.Complain("steer",
                  "must be an <intvelocity> with ctrllimited and actlimited: its ctrlrange "
                  "is the steering rate, its actrange the steering angle");
  }
  if (!m.actuator_ctrllimited[parts.drive_actuator]) {
    find.Complain("drive", "must be ctrllimited: its ctrlrange is the largest drive torque");
  }
  if (!(parts.brake_torque_front >= 0.0 && parts.brake_torque_rear >= 0.0 &&
        parts.brake_torque_front + parts.brake_torque_rear > 0.0)) {
    find.Complain("brake_torque_front", "the brake torques must not be negative, nor both zero");
  }
  parts.drive_limit = m.actuator_ctrlrange[2 * parts.drive_actuator + 1];
  return parts;
}

/// A ramp's lag behind its servo: damping over stiffness of what the servo turns.
double SteeringLag(const mjModel& m, int steer_actuator) {
  double damping = 0.0;
  for (const char* joint : {"rack", "steer_fl", "steer_fr"}) {
    const int id = mj_name2id(&m, mjOBJ_JOINT, joint);
    damping += m.dof_damping[m.jnt_dofadr[id]];
  }
  return damping / m.actuator_gainprm[mjNGAIN * steer_actuator];
}

VehicleParams ReadParams(const mjModel& m, CarParts& parts, Finder& find) {
  const std::unique_ptr<mjData, DataDeleter> data(mj_makeData(&m));
  TRACKBED_CHECK(data != nullptr, "no memory for mjData");
  mj_kinematics(&m, data.get());
  mj_comPos(&m, data.get());
  const mjtNum* origin = data->xpos + 3 * parts.chassis;
  const auto offset = [&](const mjtNum* point, int axis) { return point[axis] - origin[axis]; };
  const auto wheel = [&](std::size_t w, int axis) {
    return offset(data->xpos + 3 * parts.wheel[w], axis);
  };

  VehicleParams params;
  params.name = m.names;  // the model's own name comes first
  params.wheelbase = 0.5 * (wheel(0, 0) + wheel(1, 0)) - 0.5 * (wheel(2, 0) + wheel(3, 0));
  params.track_front = wheel(0, 1) - wheel(1, 1);
  params.track_rear = wheel(2, 1) - wheel(3, 1);
  params.wheel_radius = m.geom_size[3 * parts.tyre[0]];
  params.mass = m.body_subtreemass[parts.chassis];
  const mjtNum* cg = data->subtree_com + 3 * parts.chassis;
  params.cg_to_rear = offset(cg, 0);
  parts.cg_height = offset(cg, 2);
  const int steer = parts.steer_actuator;
  params.steering_limit = m.actuator_actrange[2 * steer + 1];
  params.steering_rate = m.actuator_ctrlrange[2 * steer + 1];
  params.steering_lag = SteeringLag(m, steer);
  params.steering_ratio = find.Number("steering_ratio");
  const int outline = find.Find(mjOBJ_SITE, "box site", "outline");
  find.ThrowIfAnything();
  if (m.site_type[outline] != mjGEOM_BOX) {
    find.Complain("outline", "must be a box site");
  }
  const mjtNum* half = m.site_size + 3 * outline;
  const mjtNum* middle = m.site_pos + 3 * outline;
  params.length = 2.0 * half[0];
  params.width = 2.0 * half[1];
  params.height = middle[2] + half[2];
  params.rear_overhang = half[0] - middle[0];

  if (std::abs(wheel(2, 0)) > 1e-6 || std::abs(wheel(3, 0)) > 1e-6) {
    find.Complain("chassis", fmt::format("the body's origin must lie under the rear axle; the rear "
                                         "wheels are {:.4g} m ahead of it",
                                         0.5 * (wheel(2, 0) + wheel(3, 0))));
  }
  if (!(params.wheelbase > 0.0 && params.steering_limit > 0.0 && params.steering_rate > 0.0 &&
        params.steering_limit < 1.5 && params.track_front > 0.0 && params.track_rear > 0.0)) {
    find.Complain("chassis",
                  "wheelbase, tracks, steering angle and steering rate must be positive, "
                  "with fl and rl on the left (y > 0) and x pointing forward");
  }
  find.ThrowIfAnything();
  return params;
}

}  // namespace

CarModel::CarModel(Scene scene, const std::string& name_for_messages)
    : scene_(std::move(scene)), model_(Compile(scene_, name_for_messages)) {
  Finder find(*model_, name_for_messages);
  parts_ = FindParts(*model_, find);
  params_ = ReadParams(*model_, parts_, find);
}

CarModel::CarModel(CarModel&&) noexcept = default;
CarModel& CarModel::operator=(CarModel&&) noexcept = default;
CarModel::~CarModel() = default;

void CarModel::Deleter::operator()(mjModel_* model) const {
  mj_deleteModel(model);
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

std::vector<double> CarModel::ConfigurationOf(std::span<const double> qpos) const {
  const auto chassis = qpos.subspan(static_cast<std::size_t>(parts_.chassis_qpos), 7);
  std::vector<double> values(chassis.begin(), chassis.end());
  for (int joint = 0; joint < model_->njnt; ++joint) {
    const int type = model_->jnt_type[joint];
    if (type == mjJNT_HINGE || type == mjJNT_SLIDE) {
      values.push_back(qpos[static_cast<std::size_t>(model_->jnt_qposadr[joint])]);
    }
  }
  return values;
}

std::vector<double> CarModel::FlatPosition(const Pose2& pose, double steering,
                                           const std::array<double, 4>& spin) const {
  std::vector<double> qpos(model_->qpos0, model_->qpos0 + model_->nq);
  const auto set = [&](int address, double value) {
    qpos[static_cast<std::size_t>(address)] = value;
  };
  set(parts_.chassis_qpos, pose.x);
  set(parts_.chassis_qpos + 1, pose.y);
  set(parts_.chassis_qpos + 3, std::cos(0.5 * pose.yaw));
  set(parts_.chassis_qpos + 4, 0.0);
  set(parts_.chassis_qpos + 5, 0.0);
  set(parts_.chassis_qpos + 6, std::sin(0.5 * pose.yaw));
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    set(parts_.spin_qpos[w], spin[w]);
  }
  const FrontAngles front = AckermannAngles(params_, steering);
  set(parts_.steer_qpos[0], front.left);
  set(parts_.steer_qpos[1], front.right);
  set(parts_.rack_qpos, steering);
  return qpos;
}

std::vector<double> CarModel::FlatConfiguration(const Pose2& pose, double steering,
                                                const std::array<double, 4>& spin) const {
  return ConfigurationOf(FlatPosition(pose, steering, spin));
}

std::array<double, 4> RollingSpeeds(const VehicleParams& params, double speed, double steering) {
  const double yaw_rate = speed * CurvatureForSteering(params, steering);
  const FrontAngles front = AckermannAngles(params, steering);
  const auto front_speed = [&](double angle, double y) {
    return (speed - yaw_rate * y) * std::cos(angle) + yaw_rate * params.wheelbase * std::sin(angle);
  };
  return {front_speed(front.left, 0.5 * params.track_front),
          front_speed(front.right, -0.5 * params.track_front),
          speed - yaw_rate * 0.5 * params.track_rear, speed + yaw_rate * 0.5 * params.track_rear};
}

}  // namespace trackbed
