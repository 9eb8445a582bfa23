#include "src/sim/car_parts.h"

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "src/sim/tyre_reader.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

/// What decimal fractions in a file may be off by [m], and axes and relative sizes [1].
constexpr double kExact = 1e-6;
/// Cosine of the most that a wheel's axes may lean away from the car's: toe, camber, kingpin.
constexpr double kUpright = 0.7;

double Square(double value) {
  return value * value;
}

class CarReader {
 public:
  CarReader(const mjModel& model, const std::string& file)
      : m_(model), file_(file), data_(mj_makeData(&model)) {
    TRACKBED_CHECK(data_ != nullptr, "no memory for mjData");
    mj_kinematics(&m_, data_.get());
    mj_comPos(&m_, data_.get());
  }

  CarDescription Read() {
    FindNames();
    ThrowIfAnything();
    FindAddresses();
    CheckChassis();
    CheckDrive();
    ReadWheels();
    ReadSteering();
    ReadOutline();
    ReadTyres();
    ReadAerodynamics();
    ThrowIfAnything();
    return {parts_, params_};
  }

 private:
  void Complain(std::string name, std::string message) {
    problems_.push_back({file_, 0, 0, std::move(name), std::move(message)});
  }

  void ThrowIfAnything() const {
    if (!problems_.empty()) {
      throw InputError(problems_);
    }
  }

  int Find(int type, const char* kind, const std::string& name) {
    const int id = mj_name2id(&m_, type, name.c_str());
    if (id < 0) {
      Complain(name, fmt::format("the model has no {} of this name", kind));
    }
    return id;
  }

  int Joint(const std::string& name, int type, const char* kind) {
    const int id = Find(mjOBJ_JOINT, kind, name);
    if (id >= 0 && m_.jnt_type[id] != type) {
      Complain(name, fmt::format("must be a {}", kind));
      return -1;
    }
    return id;
  }

  double Number(const std::string& name) {
    const int id = Find(mjOBJ_NUMERIC, "<custom><numeric>", name);
    return id < 0 ? 0.0 : m_.numeric_data[m_.numeric_adr[id]];
  }

  void FindNames() {
    parts_.chassis = Find(mjOBJ_BODY, "body", "chassis");
    free_ = Joint("chassis", mjJNT_FREE, "free joint");
    rack_ = Joint("rack", mjJNT_HINGE, "hinge joint");
    Find(mjOBJ_GEOM, "geom", "ground");
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      const std::string wheel = kWheels[w];
      parts_.tyre[w] = Find(mjOBJ_GEOM, "geom", "tyre_" + wheel);
      spin_[w] = Joint("spin_" + wheel, mjJNT_HINGE, "hinge joint");
      if (w < steer_.size()) {
        steer_[w] = Joint("steer_" + wheel, mjJNT_HINGE, "hinge joint");
      }
    }
    outline_ = Find(mjOBJ_SITE, "box site", "outline");
    parts_.steer_actuator = Find(mjOBJ_ACTUATOR, "actuator", "steer");
    parts_.drive_actuator = Find(mjOBJ_ACTUATOR, "actuator", "drive");
    parts_.brake_torque_front = Number("brake_torque_front");
    parts_.brake_torque_rear = Number("brake_torque_rear");
    params_.steering_ratio = Number("steering_ratio");
  }

  void FindAddresses() {
    params_.name = m_.names;  // the model's own name comes first
    parts_.chassis_qpos = m_.jnt_qposadr[free_];
    parts_.chassis_dof = m_.jnt_dofadr[free_];
    parts_.rack_qpos = m_.jnt_qposadr[rack_];
    parts_.rack_dof = m_.jnt_dofadr[rack_];
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      parts_.spin_qpos[w] = m_.jnt_qposadr[spin_[w]];
      parts_.spin_dof[w] = m_.jnt_dofadr[spin_[w]];
      parts_.wheel[w] = m_.jnt_bodyid[spin_[w]];
      parts_.carrier[w] = m_.body_parentid[parts_.wheel[w]];
      // About the spin axis, which is the wheel body's y axis when its inertia is given in place.
      const mjtNum* inertia = m_.body_inertia + 3 * parts_.wheel[w];
      parts_.spin_inertia[w] = *std::max_element(inertia, inertia + 3);
      parts_.hub_height[w] = Wheel(w, 2);
    }
    for (std::size_t w = 0; w < steer_.size(); ++w) {
      parts_.steer_qpos[w] = m_.jnt_qposadr[steer_[w]];
      parts_.steer_dof[w] = m_.jnt_dofadr[steer_[w]];
    }
    parts_.steer_state = parts_.steer_actuator - (m_.nu - m_.na);  // stateful actuators come last
  }

  [[nodiscard]] std::string NameOf(int type, int id) const {
    const char* name = mj_id2name(&m_, type, id);
    return name == nullptr ? "without a name" : fmt::format("'{}'", name);
  }

  /// In the car's frame.
  [[nodiscard]] double Offset(const mjtNum* point, std::size_t axis) const {
    return point[axis] - data_->xpos[3 * static_cast<std::size_t>(parts_.chassis) + axis];
  }
  [[nodiscard]] double Wheel(std::size_t w, std::size_t axis) const {
    return Offset(data_->xpos + 3 * parts_.wheel[w], axis);
  }
  [[nodiscard]] static std::string Text(const mjtNum* v) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", v[0] + 0.0, v[1] + 0.0, v[2] + 0.0);
  }

  void CheckChassis() {
    if (const int body = m_.jnt_bodyid[free_]; body != parts_.chassis) {
      Complain("chassis", fmt::format("the free joint is that of the body {}; it must be that of "
                                      "the body 'chassis'",
                                      NameOf(mjOBJ_BODY, body)));
    }
    params_.mass = m_.body_subtreemass[parts_.chassis];
    const mjtNum* cg = data_->subtree_com + 3 * parts_.chassis;
    params_.cg_to_rear = Offset(cg, 0);
    parts_.cg_height = Offset(cg, 2);
    for (int body = 1; body < m_.nbody; ++body) {
      if (m_.body_rootid[body] != m_.body_rootid[parts_.chassis]) {
        continue;
      }
      const Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>> axes(data_->ximat +
                                                                                9 * body);
      const mjtNum* at = data_->xipos + 3 * body;
      params_.yaw_inertia += axes.row(2).cwiseAbs2().dot(
                                 Eigen::Map<const Eigen::RowVector3d>(m_.body_inertia + 3 * body)) +
                             m_.body_mass[body] * (Square(at[0] - cg[0]) + Square(at[1] - cg[1]));
    }
  }

  void CheckDrive() {
    const mjtNum* range = m_.actuator_ctrlrange + 2 * parts_.drive_actuator;
    parts_.drive_limit = range[1];
    if (!m_.actuator_ctrllimited[parts_.drive_actuator]) {
      Complain("drive", "must be ctrllimited: its ctrlrange is the largest drive torque");
    } else if (!(range[1] > 0.0)) {
      Complain("drive", fmt::format("ctrlrange {:.4g} {:.4g}: its upper end is the largest drive "
                                    "torque [N m] and must be above 0",
                                    range[0], range[1]));
    }
    numerics_.Read("drive_power", parts_.drive_power);
    if (!(parts_.drive_power >= 0.0)) {
      Complain("drive_power",
               fmt::format("must not be negative, found {:.4g}", parts_.drive_power));
    }
    if (!(parts_.brake_torque_front >= 0.0 && parts_.brake_torque_rear >= 0.0 &&
          parts_.brake_torque_front + parts_.brake_torque_rear > 0.0)) {
      Complain("brake_torque_front", "the brake torques must not be negative, nor both zero");
    }
  }

  void ReadWheels() {
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      CheckWheel(w);
    }
    params_.wheel_radius = m_.geom_size[3 * parts_.tyre[0]];
    params_.wheelbase = 0.5 * (Wheel(0, 0) + Wheel(1, 0)) - 0.5 * (Wheel(2, 0) + Wheel(3, 0));
    params_.track_front = Wheel(0, 1) - Wheel(1, 1);
    params_.track_rear = Wheel(2, 1) - Wheel(3, 1);
    if (std::abs(Wheel(2, 0)) > kExact || std::abs(Wheel(3, 0)) > kExact) {
      const double ahead = 0.5 * (Wheel(2, 0) + Wheel(3, 0));
      Complain("chassis", fmt::format("the body's origin must lie under the rear axle; the rear "
                                      "wheels are {:.4g} m {} it",
                                      std::abs(ahead), ahead < 0.0 ? "behind" : "ahead of"));
    }
    if (!(params_.wheelbase > 0.0)) {
      Complain("chassis", fmt::format("the front wheels must be ahead of the rear ones, x pointing "
                                      "forwards; they are {:.4g} m behind",
                                      -params_.wheelbase));
    }
    CheckTrack("front", "fl", "fr", params_.track_front);
    CheckTrack("rear", "rl", "rr", params_.track_rear);
  }

  void CheckTrack(const char* axle, const char* left, const char* right, double track) {
    if (!(track > 0.0)) {
      Complain("chassis", fmt::format("at the {} axle the wheel {} must be on the left of {}, y "
                                      "pointing left; it is {:.4g} m to the right",
                                      axle, left, right, -track));
    }
  }

  void CheckWheel(std::size_t w) {
    const std::string wheel = kWheels[w];
    const mjtNum* axis = m_.jnt_axis + 3 * spin_[w];
    const mjtNum* axis_W = data_->xaxis + 3 * spin_[w];
    if (!(axis[1] > 1.0 - kExact)) {
      Complain("spin_" + wheel, fmt::format("a wheel spins about its body's y axis, so that "
                                            "positive rolls forwards: axis must be 0 1 0, found {}",
                                            Text(axis)));
    } else if (!(axis_W[1] > kUpright)) {
      Complain(
          "spin_" + wheel,
          fmt::format("its axis must point to the car's left; it points along {}", Text(axis_W)));
    }
    if (const int body = m_.geom_bodyid[parts_.tyre[w]]; body != parts_.wheel[w]) {
      Complain("tyre_" + wheel,
               fmt::format("must be on the body that spin_{} turns, {}; it is on {}", wheel,
                           NameOf(mjOBJ_BODY, parts_.wheel[w]), NameOf(mjOBJ_BODY, body)));
    }
    const double radius = m_.geom_size[3 * parts_.tyre[w]];
    const double first = m_.geom_size[3 * parts_.tyre[0]];
    if (!(std::abs(radius - first) <= kExact * first)) {
      Complain("tyre_" + wheel, fmt::format("its radius is {:.6g} m and that of tyre_fl {:.6g} m; "
                                            "all four must be equal",
                                            radius, first));
    }
  }

  void ReadSteering() {
    const int steer = parts_.steer_actuator;
    const mjtNum* rate = m_.actuator_ctrlrange + 2 * steer;
    const mjtNum* angle = m_.actuator_actrange + 2 * steer;
    params_.steering_rate = rate[1];
    params_.steering_limit = angle[1];
    if (!(params_.steering_ratio > 0.0)) {
      Complain("steering_ratio",
               fmt::format("must be above 0, found {:.4g}", params_.steering_ratio));
    }
    if (m_.actuator_dyntype[steer] != mjDYN_INTEGRATOR || !m_.actuator_ctrllimited[steer] ||
        !m_.actuator_actlimited[steer]) {
      Complain("steer",
               "must be an <intvelocity> with ctrllimited and actlimited: its ctrlrange is the "
               "steering rate, its actrange the steering angle");
      return;
    }
    if (m_.actuator_trntype[steer] != mjTRN_JOINT || m_.actuator_trnid[2 * steer] != rack_) {
      Complain("steer", "must act on the joint 'rack'");
    }
    // On a ramp a servo's joint follows by damping over stiffness of all that it turns.
    double damping = m_.dof_damping[m_.jnt_dofadr[rack_]];
    for (const int joint : steer_) {
      damping += m_.dof_damping[m_.jnt_dofadr[joint]];
    }
    params_.steering_lag = damping / m_.actuator_gainprm[mjNGAIN * steer];
    CheckSymmetric("ctrlrange", "the steering rate [rad/s]", rate);
    CheckSymmetric("actrange", "the steering angle [rad]", angle);
    if (!(angle[1] < 1.5)) {
      Complain("steer",
               fmt::format("actrange {:.4g} {:.4g} is in radians and must stay below 1.5; "
                           "{:.4g} degrees are {:.4g} rad",
                           angle[0], angle[1], angle[1], angle[1] * std::numbers::pi / 180.0));
      return;
    }
    CheckRoom(rack_, "rack", angle[0], angle[1]);
    const FrontAngles left = AckermannAngles(params_, angle[1]);
    const FrontAngles right = AckermannAngles(params_, angle[0]);
    CheckRoom(steer_[0], "steer_fl", right.left, left.left);
    CheckRoom(steer_[1], "steer_fr", right.right, left.right);
    for (std::size_t w = 0; w < steer_.size(); ++w) {
      const mjtNum* axis_W = data_->xaxis + 3 * steer_[w];
      if (!(axis_W[2] > kUpright)) {
        Complain(std::string("steer_") + kWheels[w],
                 fmt::format("its axis must point up, so that positive turns left; it points along "
                             "{}",
                             Text(axis_W)));
      }
    }
  }

  void CheckSymmetric(const char* attribute, const char* meaning, const mjtNum* range) {
    if (!(std::abs(range[0] + range[1]) <= kExact * std::abs(range[1]))) {
      Complain("steer", fmt::format("{} {:.4g} {:.4g} is {} to the right and to the left, which "
                                    "must be equal",
                                    attribute, range[0], range[1], meaning));
    }
  }

  /// A joint that stops before the steering does is one whose range was meant in other units.
  void CheckRoom(int joint, const char* name, double lowest, double highest) {
    const mjtNum* range = m_.jnt_range + 2 * joint;
    if (!m_.jnt_limited[joint]) {
      return;
    }
    if (range[0] > lowest + kExact || range[1] < highest - kExact) {
      Complain(name, fmt::format(
                         "its range, {:.4g} to {:.4g} rad, stops before the {:.4g} to {:.4g} rad "
                         "that steering needs; without <compiler angle=\"radian\"/> a range is in "
                         "degrees",
                         range[0], range[1], lowest, highest));
    } else if (range[0] < -std::numbers::pi || range[1] > std::numbers::pi) {
      Complain(name, fmt::format("its range, {:.4g} to {:.4g} rad, is more than half a turn; with "
                                 "<compiler angle=\"radian\"/> a range is in radians",
                                 range[0], range[1]));
    }
  }

  void ReadTyres() {
    parts_.tyres = trackbed::ReadTyres(numerics_);
    if (!parts_.tyres) {
      return;
    }
    const double load = 0.5 * params_.mass * std::abs(m_.opt.gravity[2]) / params_.wheelbase;
    params_.cornering_stiffness_front =
        2.0 * CorneringStiffness(parts_.tyres->axle[0], load * params_.cg_to_rear);
    params_.cornering_stiffness_rear =
        2.0 * CorneringStiffness(parts_.tyres->axle[1], load * params_.cg_to_front());
  }

  void ReadAerodynamics() {
    CarAerodynamics& air = parts_.aerodynamics;
    numerics_.Read("drag_area", air.drag_area);
    numerics_.Read("side_area", air.side_area);
    air.centre_of_pressure = {params_.cg_to_rear, parts_.cg_height};
    if (const mjtNum* at = numerics_.Find("centre_of_pressure", 2)) {
      air.centre_of_pressure = {at[0], at[1]};
    }
    if (!(air.drag_area >= 0.0 && air.side_area >= 0.0)) {
      Complain("drag_area", "drag_area and side_area must not be negative");
    }
  }

  void ReadOutline() {
    if (m_.site_type[outline_] != mjGEOM_BOX) {
      Complain("outline", "must be a box site");
    }
    if (const int body = m_.site_bodyid[outline_]; body != parts_.chassis) {
      Complain("outline", fmt::format("must be a site of the body 'chassis'; it is on {}",
                                      NameOf(mjOBJ_BODY, body)));
    }
    const mjtNum* half = m_.site_size + 3 * outline_;
    const mjtNum* middle = m_.site_pos + 3 * outline_;
    const mjtNum* turn = m_.site_quat + 4 * outline_;
    if (std::abs(middle[1]) > kExact || !(std::abs(turn[0]) > 1.0 - kExact)) {
      Complain("outline", "must be centred on y = 0 and not turned");
    }
    params_.length = 2.0 * half[0];
    params_.width = 2.0 * half[1];
    params_.height = middle[2] + half[2];
    params_.rear_overhang = half[0] - middle[0];
  }

  const mjModel& m_;
  std::string file_;
  std::unique_ptr<mjData, DataDeleter> data_;
  std::vector<Problem> problems_;
  Numerics numerics_{
      m_, [this](const std::string& name, const std::string& message) { Complain(name, message); }};
  CarParts parts_;
  VehicleParams params_;
  int free_ = -1;  // joints
  int rack_ = -1;
  std::array<int, 4> spin_{};
  std::array<int, 2> steer_{};
  int outline_ = -1;  // site
};

}  // namespace

const CarTyres& TyresOf(const CarModel& car, const std::string& needed_by) {
  const auto& tyres = car.parts().tyres;
  if (!tyres) {
    throw InputError(Problem{
        .file = car.file(),
        .message = fmt::format("the car {} has no tyre coefficients; {} needs them in <custom>: {}",
                               car.params().name, needed_by, kNeededCoefficients)});
  }
  return *tyres;
}

CarDescription DescribeCar(const mjModel& model, const std::string& file) {
  return CarReader(model, file).Read();
}

}  // namespace trackbed
