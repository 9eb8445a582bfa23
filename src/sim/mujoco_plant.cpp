#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "src/sim/mujoco_error.h"
#include "src/sim/plants.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Below this the car counts as standing and is held by its brakes [m/s].
constexpr double kStandstill = 0.01;

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
        model_(mj_copyModel(nullptr, setup.car.get())),
        data_(mj_makeData(model_.get())),
        ground_(mj_name2id(setup.car.get(), mjOBJ_GEOM, "ground")) {
    TRACKBED_CHECK(model_ && data_, "no memory for the simulation");
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      // Sliding friction only: torsion and rolling are lengths, not properties of the road.
      model_->geom_friction[3 * car_.parts().tyre[w]] *= setup.world.friction;
      bearing_friction_[w] = model_->dof_frictionloss[car_.parts().spin_dof[w]];
    }
    Reset(setup.start);
  }

  void Step(const Command& command) override {
    Steer(command.steering);
    Propel(command);
    mj_step(model_.get(), data_.get());
    const double yaw = Yaw();
    yaw_ += AngleDifference(yaw, yaw_);
    distance_ += std::abs(Speed()) * model_->opt.timestep;
  }

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
  [[nodiscard]] std::array<WheelState, 4> Wheels() const;
  [[nodiscard]] double ObstacleForce() const;

  const CarModel& car_;
  std::unique_ptr<mjModel, ModelDeleter> model_;  // own copy: brakes and road change it
  std::unique_ptr<mjData, DataDeleter> data_;
  std::array<double, 4> bearing_friction_{};  // [N m]
  double yaw_ = 0.0;                          // unwrapped [rad]
  int ground_;                                // geom
  double distance_ = 0.0;                     // [m]
};

void MujocoPlant::Reset(const StartState& start) {
  mj_resetData(model_.get(), data_.get());
  const CarParts& parts = car_.parts();
  const auto qpos = car_.FlatPosition(start.pose, start.steering, {});
  std::copy(qpos.begin(), qpos.end(), data_->qpos);
  const Vec2 ahead = Direction(start.pose.yaw);
  mjtNum* velocity = data_->qvel + parts.chassis_dof;
  velocity[0] = start.speed * ahead.x();
  velocity[1] = start.speed * ahead.y();
  velocity[5] = start.speed * CurvatureForSteering(car_.params(), start.steering);
  const auto rolling = RollingSpeeds(car_.params(), start.speed, start.steering);
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    data_->qvel[parts.spin_dof[w]] = rolling[w] / car_.params().wheel_radius;
  }
  data_->act[parts.steer_state] = start.steering;
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
  double rolling_mass = car_.params().mass;  // with the wheels' own inertia
  for (const double inertia : parts.spin_inertia) {
    rolling_mass += inertia / (radius * radius);
  }
  double bearings = 0.0;  // [N m]
  for (const double friction : bearing_friction_) {
    bearings += friction;
  }
  const double along_gear = command.acceleration * command.gear;
  const bool hold = along_gear <= 0.0 && Speed() * command.gear < kStandstill;
  // What motor or brakes have to do beyond what the bearings do already, as a torque at the wheels.
  const double torque = along_gear * rolling_mass * radius + bearings;
  const bool drive = torque > 0.0 && !hold;
  data_->ctrl[parts.drive_actuator] =
      drive ? command.gear * std::min(torque, parts.drive_limit) : 0.0;
  Brake(drive ? 0.0 : -torque, hold);
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

VehicleState MujocoPlant::Observe() const {
  const VehicleParams& params = car_.params();
  const mjtNum* position = ChassisPosition();
  const Matrix3d R_WV = ChassisRotation();
  const Vector3d v_W = Vec(ChassisVelocity());             // of V's origin
  const Vector3d w_W = R_WV * Vec(ChassisVelocity() + 3);  // free joints spin in their own frame
  const mjtNum* qacc = data_->qacc + car_.parts().chassis_dof;
  const Vector3d a_W = Vec(qacc);
  const Vector3d alpha_W = R_WV * Vec(qacc + 3);
  const Vector3d to_cg_W = R_WV * Vector3d(params.cg_to_rear, 0.0, car_.parts().cg_height);
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
  state.wheels = Wheels();
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

std::array<WheelState, 4> MujocoPlant::Wheels() const {
  const CarParts& parts = car_.parts();
  std::array<Vector3d, 4> force_W;  // on the wheel
  force_W.fill(Vector3d::Zero());
  std::array<Vector3d, 4> normal_W;
  normal_W.fill(Vector3d::UnitZ());
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      const bool first = contact.geom1 == parts.tyre[w];
      const bool on_road = first ? contact.geom2 == ground_ : contact.geom1 == ground_;
      if ((!first && contact.geom2 != parts.tyre[w]) || !on_road) {
        continue;
      }
      std::array<mjtNum, 6> force{};
      mj_contactForce(model_.get(), data_.get(), i, force.data());
      // Rows of the contact frame; its x axis points from geom1 to geom2.
      const double sign = first ? -1.0 : 1.0;
      for (int axis = 0; axis < 3; ++axis) {
        force_W[w] += sign * force[static_cast<std::size_t>(axis)] * Vec(contact.frame + 3 * axis);
      }
      normal_W[w] = sign * Vec(contact.frame);
    }
  }

  std::array<WheelState, 4> wheels;
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const Vector3d up = normal_W[w];
    const mjtNum* rotation = data_->xmat + 9 * parts.wheel[w];
    const Vector3d spin_axis(rotation[1], rotation[4], rotation[7]);  // the wheel's y axis
    const Vector3d forward = spin_axis.cross(up).normalized();
    const Vector3d left = up.cross(forward);
    std::array<mjtNum, 6> hub{};  // angular, linear
    mj_objectVelocity(model_.get(), data_.get(), mjOBJ_BODY, parts.wheel[w], hub.data(), 0);
    std::array<mjtNum, 6> carrier{};
    mj_objectVelocity(model_.get(), data_.get(), mjOBJ_BODY, parts.carrier[w], carrier.data(), 0);
    const double radius = car_.params().wheel_radius;
    // Of the contact point, carried along without the spin.
    const Vector3d v_W = Vec(hub.data() + 3) + Vec(carrier.data()).cross(-radius * up);
    const double v_x = forward.dot(v_W);
    const double v_y = left.dot(v_W);
    const double rolling = data_->qvel[parts.spin_dof[w]] * radius;
    WheelState& wheel = wheels[w];
    wheel.normal_force = std::max(0.0, up.dot(force_W[w]));
    wheel.longitudinal_force = forward.dot(force_W[w]);
    wheel.lateral_force = left.dot(force_W[w]);
    // Slip is relative to the speed; near standstill to the speed at which a car counts as
    // standing.
    const double reference = std::max(std::abs(v_x), kStandstill);
    wheel.slip_angle = std::atan2(v_y, reference);
    wheel.slip_ratio = (rolling - v_x) / reference;
  }
  return wheels;
}

}  // namespace

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup) {
  return std::make_unique<MujocoPlant>(setup);
}

}  // namespace trackbed
