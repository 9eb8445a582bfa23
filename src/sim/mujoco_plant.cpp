#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "src/sim/magic_formula_tyres.h"
#include "src/sim/mujoco_error.h"
#include "src/sim/plants.h"
#include "src/sim/road_contact.h"
#include "src/sim/wheel_contacts.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Below this the car counts as standing and is held by its brakes [m/s].
constexpr double kStandstill = 0.01;
constexpr double kAirDensity = 1.225;  // ISO 2533 at sea level [kg/m^3]

Vector3d Vec(const mjtNum* numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

class MujocoPlant final : public Plant {
 public:
  explicit MujocoPlant(const PlantSetup& setup)
      : car_(setup.car),
        world_(setup.world),
        prescribed_(setup.steering == SteeringInput::kPrescribed),
        model_(mj_copyModel(nullptr, setup.car.get())),
        data_(mj_makeData(model_.get())) {
    TRACKBED_CHECK(model_ && data_, "no memory for the simulation");
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      tyre_friction_[w] = model_->geom_friction[3 * car_.parts().tyre[w]];
      bearing_friction_[w] = model_->dof_frictionloss[car_.parts().spin_dof[w]];
    }
    if (setup.tyre == TyreLaw::kMagicFormula) {
      tyres_.emplace(car_, *model_);
    }
    ground_.emplace(car_, *model_);
    Reset(setup.start);
  }

  void Step(const Command& command) override {
    if (prescribed_) {
      PrescribeVelocity(command.steering);
    } else {
      Steer(command.steering);
    }
    Propel(command);
    ground_->Place(*model_, *data_);
    const std::array<double, 4> road = Road();
    const std::array<double, 4> loads = RoadLoads(car_, *model_, *data_);  // of the last solve
    mj_step1(model_.get(), data_.get());
    std::fill_n(data_->qfrc_applied, model_->nv, 0.0);
    PushByAir();
    PushAside();
    if (tyres_) {
      tyres_->Apply(*model_, *data_, loads, road);
    }
    mj_step2(model_.get(), data_.get());
    if (prescribed_) {
      PrescribeAngle(command.steering);
    }
    const double yaw = Yaw();
    yaw_ += AngleDifference(yaw, yaw_);
    distance_ += std::abs(Speed()) * model_->opt.timestep;
  }

  void Shift(double left) override;

  void Push(double force) override { push_ = force; }

  [[nodiscard]] VehicleState Observe() const override;

  [[nodiscard]] std::vector<double> Configuration() const override {
    return car_.ConfigurationOf({data_->qpos, static_cast<std::size_t>(model_->nq)});
  }

  [[nodiscard]] bool diverged() const override {
    return std::any_of(std::begin(data_->warning), std::end(data_->warning),
                       [](const mjWarningStat& warning) { return warning.number > 0; });
  }

 private:
  void Reset(const StartState& start);
  void Steer(double wanted);
  void Propel(const Command& command);
  void Brake(double torque, bool hold);
  [[nodiscard]] double DriveLimit() const;

  [[nodiscard]] const mjtNum* ChassisPosition() const {
    return data_->qpos + car_.parts().chassis_qpos;
  }
  [[nodiscard]] const mjtNum* ChassisVelocity() const {
    return data_->qvel + car_.parts().chassis_dof;
  }
  [[nodiscard]] Matrix3d ChassisRotation() const {
    const mjtNum* q = ChassisPosition() + 3;
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  }
  [[nodiscard]] double Yaw() const {
    const mjtNum* q = ChassisPosition() + 3;
    return std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
  }
  [[nodiscard]] double Speed() const {
    const Vec2 ahead = Direction(Yaw());
    const mjtNum* v = ChassisVelocity();
    return ahead.x() * v[0] + ahead.y() * v[1];
  }
  [[nodiscard]] double MeasuredSteering() const {
    const auto& steer = car_.parts().steer_qpos;
    return BicycleAngle(car_.params(), {data_->qpos[steer[0]], data_->qpos[steer[1]]});
  }
  [[nodiscard]] std::array<double, 4> Road();
  [[nodiscard]] Vector3d AirSpeed() const;
  void PushByAir();
  void PushAside();
  [[nodiscard]] double Resistance(int gear) const;
  void PrescribeVelocity(double steering);
  void PrescribeAngle(double steering);
  [[nodiscard]] std::array<WheelState, 4> ContactWheels() const;
  [[nodiscard]] double ObstacleForce() const;

  const CarModel& car_;
  const World& world_;
  bool prescribed_;                               // steering
  std::unique_ptr<mjModel, ModelDeleter> model_;  // own copy: brakes and road change it
  std::unique_ptr<mjData, DataDeleter> data_;
  std::optional<RoadContact> ground_;
  std::optional<MagicFormulaTyres> tyres_;    // none: contacts hold the wheels
  std::array<double, 4> tyre_friction_{};     // of the contacts, on a road of factor 1
  std::array<double, 4> bearing_friction_{};  // [N m]
  double yaw_ = 0.0;                          // unwrapped [rad]
  double distance_ = 0.0;                     // [m]
  double push_ = 0.0;                         // to the left, in the coming step [N]
};

void MujocoPlant::Reset(const StartState& start) {
  mj_resetData(model_.get(), data_.get());
  const CarParts& parts = car_.parts();
  const auto qpos = car_.StandingPosition(start.pose, start.steering, {}, car_.scene().ground);
  std::copy(qpos.begin(), qpos.end(), data_->qpos);
  mjtNum* velocity = data_->qvel + parts.chassis_dof;
  const Vector3d ahead_W = car_.AheadOnGround(start.pose, car_.scene().ground);
  Eigen::Map<Vector3d>{velocity} = start.speed / ahead_W.head<2>().norm() * ahead_W;
  velocity[5] = start.speed * CurvatureForSteering(car_.params(), start.steering);
  const auto rolling = RollingSpeeds(car_.params(), start.speed, start.steering);
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    data_->qvel[parts.spin_dof[w]] = rolling[w] / car_.params().wheel_radius;
  }
  data_->act[parts.steer_state] = start.steering;
  ground_->Place(*model_, *data_);
  mj_forward(model_.get(), data_.get());
  yaw_ = start.pose.yaw;
}

void MujocoPlant::Steer(double wanted) {
  const VehicleParams& params = car_.params();
  const double reachable = std::clamp(wanted, -params.steering_limit, params.steering_limit);
  const double rate = (reachable - data_->act[car_.parts().steer_state]) / model_->opt.timestep;
  data_->ctrl[car_.parts().steer_actuator] =
      std::clamp(rate, -params.steering_rate, params.steering_rate);
}

void MujocoPlant::Propel(const Command& command) {
  const CarParts& parts = car_.parts();
  const double radius = car_.params().wheel_radius;
  double rolling_mass = car_.unladen().mass;  // with the wheels' own inertia
  for (const double inertia : parts.spin_inertia) {
    rolling_mass += inertia / (radius * radius);
  }
  const double along_gear = command.acceleration * command.gear;
  const bool hold = along_gear <= 0.0 && Speed() * command.gear < kStandstill;
  // What motor or brakes have to do beyond what slows the car anyway, as a torque at the wheels.
  const double torque = along_gear * rolling_mass * radius + Resistance(command.gear);
  const bool drive = torque > 0.0 && !hold;
  data_->ctrl[parts.drive_actuator] = drive ? command.gear * std::min(torque, DriveLimit()) : 0.0;
  Brake(drive ? 0.0 : -torque, hold);
}

/// Largest drive torque at the speed now [N m].
double MujocoPlant::DriveLimit() const {
  const CarParts& parts = car_.parts();
  const double full = parts.drive_limit * std::abs(Speed());
  const double power = parts.drive_power * car_.params().wheel_radius;
  return parts.drive_power > 0.0 && full > power ? power / std::abs(Speed()) : parts.drive_limit;
}

void MujocoPlant::Brake(double torque, bool hold) {
  const CarParts& parts = car_.parts();
  const double all = 2.0 * (parts.brake_torque_front + parts.brake_torque_rear);
  const double share = hold ? 1.0 : std::clamp(torque / all, 0.0, 1.0);
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const double largest = w < 2 ? parts.brake_torque_front : parts.brake_torque_rear;
    model_->dof_frictionloss[parts.spin_dof[w]] = bearing_friction_[w] + share * largest;
  }
}

/// What bearings, rolling tyres and air take from a drive torque along the gear [N m].
double MujocoPlant::Resistance(int gear) const {
  double dry = tyres_ ? tyres_->RollingMoment() : 0.0;
  for (const double friction : bearing_friction_) {
    dry += friction;
  }
  const Vector3d air_V = ChassisRotation().transpose() * AirSpeed();
  const double drag =
      -0.5 * kAirDensity * air_V.norm() * air_V.x() * car_.parts().aerodynamics.drag_area;
  return dry + gear * drag * car_.params().wheel_radius;
}

/// The road's factor under each wheel, which is the contacts' as well.
std::array<double, 4> MujocoPlant::Road() {
  std::array<double, 4> road{};
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const mjtNum* hub = data_->xpos + 3 * car_.parts().wheel[w];
    road[w] = RoadFactor(world_, {hub[0], hub[1]});
    // Sliding friction only: torsion and rolling are lengths, not properties of the road.
    model_->geom_friction[3 * car_.parts().tyre[w]] = tyre_friction_[w] * road[w];
  }
  return road;
}

/// Of the air relative to the car, world frame [m/s].
Vector3d MujocoPlant::AirSpeed() const {
  const mjtNum* at = ChassisPosition();
  const Vec2 wind = WindAt(world_, {at[0], at[1]}, data_->time);
  return Vector3d(wind.x(), wind.y(), 0.0) - Vec(ChassisVelocity());
}

void MujocoPlant::PushByAir() {
  const CarAerodynamics& car = car_.parts().aerodynamics;
  const Matrix3d R_WV = ChassisRotation();
  const Vector3d air_V = R_WV.transpose() * AirSpeed();
  const double pressure = 0.5 * kAirDensity * air_V.head<2>().norm();
  const Vector3d force_W = R_WV * Vector3d(pressure * air_V.x() * car.drag_area,
                                           pressure * air_V.y() * car.side_area, 0.0);
  const Vector3d at_W = Vec(ChassisPosition()) +
                        R_WV * Vector3d(car.centre_of_pressure[0], 0.0, car.centre_of_pressure[1]);
  const std::array<mjtNum, 3> no_moment{};
  mj_applyFT(model_.get(), data_.get(), force_W.data(), no_moment.data(), at_W.data(),
             car_.parts().chassis, data_->qfrc_applied);
}

void MujocoPlant::Shift(double left) {
  mjtNum* at = data_->qpos + car_.parts().chassis_qpos;
  const Vec2 from(at[0], at[1]);
  const Vec2 to = from + left * LeftOf(Direction(Yaw()));
  at[0] = to.x();
  at[1] = to.y();
  at[2] += GroundHeight(world_, to) - GroundHeight(world_, from);
}

void MujocoPlant::PushAside() {
  if (push_ == 0.0) {
    return;
  }
  const Vec2 force = push_ * LeftOf(Direction(Yaw()));
  const Vector3d force_W(force.x(), force.y(), 0.0);
  const std::array<mjtNum, 3> no_moment{};
  mj_applyFT(model_.get(), data_.get(), force_W.data(), no_moment.data(),
             data_->subtree_com + 3 * car_.parts().chassis, car_.parts().chassis,
             data_->qfrc_applied);
  push_ = 0.0;
}

/// The wheels move to `steering` during the coming step, whatever forces say.
void MujocoPlant::PrescribeVelocity(double steering) {
  const CarParts& parts = car_.parts();
  const double timestep = model_->opt.timestep;
  const FrontAngles to = AckermannAngles(car_.params(), steering);
  data_->qvel[parts.rack_dof] = (steering - data_->qpos[parts.rack_qpos]) / timestep;
  data_->qvel[parts.steer_dof[0]] = (to.left - data_->qpos[parts.steer_qpos[0]]) / timestep;
  data_->qvel[parts.steer_dof[1]] = (to.right - data_->qpos[parts.steer_qpos[1]]) / timestep;
  data_->ctrl[parts.steer_actuator] = 0.0;
}

void MujocoPlant::PrescribeAngle(double steering) {
  const CarParts& parts = car_.parts();
  const FrontAngles at = AckermannAngles(car_.params(), steering);
  data_->qpos[parts.rack_qpos] = steering;
  data_->qpos[parts.steer_qpos[0]] = at.left;
  data_->qpos[parts.steer_qpos[1]] = at.right;
  data_->act[parts.steer_state] = steering;
}

VehicleState MujocoPlant::Observe() const {
  const VehicleParams& params = car_.params();
  const mjtNum* position = ChassisPosition();
  const Matrix3d R_WV = ChassisRotation();
  const Vector3d v_W = Vec(ChassisVelocity());             // of V's origin
  const Vector3d w_W = R_WV * Vec(ChassisVelocity() + 3);  // free joints spin in their own frame
  const mjtNum* qacc = data_->qacc + car_.parts().chassis_dof;
  const Vector3d a_W = Vec(qacc);
  const Vector3d alpha_W = R_WV * Vec(qacc + 3);
  // On the ground, as the pose is: rolling is no motion of the car along y.
  const Vector3d to_cg_W = R_WV * Vector3d(params.cg_to_rear, 0.0, 0.0);
  const Vector3d v_cg_W = v_W + w_W.cross(to_cg_W);
  const Vector3d a_cg_W = a_W + alpha_W.cross(to_cg_W) + w_W.cross(w_W.cross(to_cg_W));

  const Vec2 ahead = Direction(Yaw());
  const Vec2 left = LeftOf(ahead);
  VehicleState state;
  state.time = data_->time;
  state.pose = {position[0], position[1], yaw_};
  state.speed = ahead.dot(v_W.head<2>());
  state.distance = distance_;
  state.lateral_speed = left.dot(v_cg_W.head<2>());
  state.yaw_rate = w_W.z();
  state.pitch = std::asin(std::clamp(-R_WV(2, 0), -1.0, 1.0));
  state.roll = std::atan2(R_WV(2, 1), R_WV(2, 2));
  state.longitudinal_acceleration = ahead.dot(a_cg_W.head<2>());
  state.lateral_acceleration = left.dot(a_cg_W.head<2>());
  const double cg_speed = ahead.dot(v_cg_W.head<2>());
  // A direction of motion needs motion: at rest the angle would be that of rounding errors.
  state.sideslip =
      v_cg_W.head<2>().norm() < kStandstill ? 0.0 : std::atan(state.lateral_speed / cg_speed);
  state.steering_actuator = data_->act[car_.parts().steer_state];
  state.steering = MeasuredSteering();
  state.wheels = tyres_ ? tyres_->wheels() : ContactWheels();
  state.obstacle_force = ObstacleForce();
  return state;
}

double MujocoPlant::ObstacleForce() const {
  double sum = 0.0;
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    const auto is_obstacle = [&](int geom) {
      const char* name = mj_id2name(model_.get(), mjOBJ_GEOM, geom);
      return name != nullptr && std::string_view(name).starts_with("obstacle_");
    };
    if (is_obstacle(contact.geom1) || is_obstacle(contact.geom2)) {
      std::array<mjtNum, 6> force{};
      mj_contactForce(model_.get(), data_.get(), i, force.data());
      sum += force[0];
    }
  }
  return sum;
}

std::array<WheelState, 4> MujocoPlant::ContactWheels() const {
  const auto forces = RoadForces(car_, *model_, *data_);
  const auto contacts = FindWheelContacts(car_, *model_, *data_);
  std::array<WheelState, 4> wheels;
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const WheelContact& contact = contacts[w];
    // Slip is relative to the speed; near standstill to the speed at which a car counts as
    // standing.
    const double reference = std::max(std::abs(contact.rolling_speed), kStandstill);
    wheels[w] = {.normal_force = std::max(0.0, contact.up.dot(forces[w])),
                 .longitudinal_force = contact.forward.dot(forces[w]),
                 .lateral_force = contact.left.dot(forces[w]),
                 .slip_angle = std::atan2(contact.slip_speed_y, reference),
                 .slip_ratio = contact.slip_speed_x / reference};
  }
  return wheels;
}

}  // namespace

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup) {
  return std::make_unique<MujocoPlant>(setup);
}

}  // namespace trackbed
