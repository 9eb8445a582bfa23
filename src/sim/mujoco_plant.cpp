#include "src/sim/mujoco_plant.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "src/sim/joint_forces.h"
#include "src/sim/mujoco_compat.h"
#include "src/sim/plants.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/mujoco_error.h"

// Simulates a vehicle with MuJoCo. A step of the plant has five parts:
//   1. The derived plant class sets actuators and brakes (Act). The planes under the tyres are
//      moved along the ground. Moving obstacles get their planned state, and the tyre contacts get
//      the road's friction.
//   2. MuJoCo's mj_step1 computes the positions and velocities on which the forces of part 3
//      depend.
//   3. The forces of the air, of the lateral push and of the wheels (ApplyWheelForces) are applied.
//   4. MuJoCo's mj_step2 integrates the motion.
//   5. The derived plant class ends the step (Finish).
namespace trackbed {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d Vec(const mjtNum* numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

/// Whether the model has two geoms that may touch and belong to bodies that move relative to each
/// other.
bool HasCollidableGeoms(const mjModel& model) {
  const auto may_touch = [&](int a, int b) {
    return model.body_weldid[model.geom_bodyid[a]] != model.body_weldid[model.geom_bodyid[b]] &&
           ((model.geom_contype[a] & model.geom_conaffinity[b]) != 0 ||
            (model.geom_contype[b] & model.geom_conaffinity[a]) != 0);
  };
  for (int a = 0; a < model.ngeom; ++a) {
    for (int b = 0; b < a; ++b) {
      if (may_touch(a, b)) {
        return true;
      }
    }
  }
  return model.npair > 0;
}

}  // namespace

MujocoPlant::MujocoPlant(const PlantSetup& setup, TyreSupport support)
    : MujocoSimulation(*setup.car.get()),
      car_(setup.car),
      world_(setup.world),
      ground_(car_, support, *model_) {
  const std::span<const int> tyres = car_.tyres();
  for (std::size_t w = 0; w < tyres.size(); ++w) {
    tyre_friction_[w] = model_->geom_friction[3 * tyres[w]];
  }
  const int chassis = model_->dof_bodyid[car_.chassis().chassis_dof];
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    const char* name = mj_id2name(model_.get(), mjOBJ_GEOM, geom);
    is_obstacle_.push_back(name != nullptr && std::string_view(name).starts_with("obstacle_"));
    is_of_car_.push_back(model_->body_rootid[model_->geom_bodyid[geom]] ==
                         model_->body_rootid[chassis]);
  }
  const StartState& start = setup.start;
  const Ground& ground = car_.scene().ground;
  const auto qpos =
      car_.StandingPosition(start.pose, start.steering, {}, ground, start.hitch_angle);
  std::copy(qpos.begin(), qpos.end(), data_->qpos);
  mjtNum* velocity = data_->qvel + car_.chassis().chassis_dof;
  const Vector3d ahead_W = car_.AheadOnGround(start.pose, ground);
  Eigen::Map<Vector3d>{velocity} = start.speed / ahead_W.head<2>().norm() * ahead_W;
  velocity[5] =
      start.yaw_rate.value_or(start.speed * CurvatureForSteering(car_.params(), start.steering));
  if (start.lateral_speed) {
    const Vec2 sideways = *start.lateral_speed * LeftNormal(Direction(start.pose.yaw));
    velocity[0] += sideways.x();
    velocity[1] += sideways.y();
  }
  if (car_.trailer()) {
    StartTrailer(start);
  }
  yaw_ = start.pose.yaw;
  for (std::size_t i = 0; i < world_.obstacles.size(); ++i) {
    const Obstacle& obstacle = world_.obstacles[i];
    if (!obstacle.moves()) {
      continue;
    }
    const auto joint_of = [&](const char* axis) {
      const std::string name = fmt::format("obstacle_{}_{}", i, axis);
      const int joint = mj_name2id(model_.get(), mjOBJ_JOINT, name.c_str());
      TRACKBED_CHECK(joint >= 0, "the scene has no joint '{}'", name);
      return MovedJoint{model_->jnt_qposadr[joint], model_->jnt_dofadr[joint]};
    };
    movers_.push_back({i, joint_of("x"), joint_of("y"),
                       obstacle.motion.empty() ? std::nullopt : std::optional(joint_of("yaw"))});
  }
}

/// Sets the velocities of the hitch and of the trailer's wheels to those of a trailer whose wheels
/// do not slip.
void MujocoPlant::StartTrailer(const StartState& start) {
  const TrailerParts& trailer = *car_.trailer();
  const TrailerParams& params = trailer.params;
  const double yaw_rate = data_->qvel[car_.chassis().chassis_dof + 5];
  const double rate = RollingHitchRate(params, start.hitch_angle, start.speed, yaw_rate);
  data_->qvel[trailer.hitch_dof[0]] = rate;
  const double speed = start.speed * std::cos(start.hitch_angle) -
                       params.hitch * yaw_rate * std::sin(start.hitch_angle);
  const double side = 0.5 * params.track * (yaw_rate + rate);
  data_->qvel[trailer.spin_dof[0]] = (speed - side) / params.wheel_radius;
  data_->qvel[trailer.spin_dof[1]] = (speed + side) / params.wheel_radius;
  trailer_friction_ = model_->geom_friction[3 * trailer.tyre[0]];
}

void MujocoPlant::RollWheels(std::span<const int> spin_dof, const StartState& start) {
  const WheelSpeeds rolling = RollingSpeeds(car_.params(), start.speed, start.steering);
  for (std::size_t w = 0; w < spin_dof.size(); ++w) {
    data_->qvel[spin_dof[w]] = rolling[static_cast<Eigen::Index>(w)] / car_.params().wheel_radius;
  }
}

void MujocoPlant::Begin() {
  const MujocoErrorScope errors;
  if (!HasCollidableGeoms(*model_)) {
    // disables the search for contacts, which would take 11 % of a step's run time
    model_->opt.disableflags |= mjDSBL_CONTACT;
  }
  ground_.Place(*model_, *data_);
  MoveObstacles();
  mj_forward(model_.get(), data_.get());
}

void MujocoPlant::Step(const Command& command) {
  TRACKBED_REQUIRE(std::isfinite(command.steering) && std::isfinite(command.acceleration),
                   "Step: steering {}, acceleration {}; must be finite", command.steering,
                   command.acceleration);
  const MujocoErrorScope errors;
  Act(command);
  ground_.Place(*model_, *data_);
  MoveObstacles();
  const Road road = UpdateRoadFriction();
  mj_step1(model_.get(), data_.get());
  std::fill_n(data_->qfrc_applied, model_->nv, 0.0);
  ApplyAirForce();
  ApplyPendingLateralForce();
  ApplyWheelForces(road);
  mj_step2(model_.get(), data_.get());
  Finish(command);
  const double yaw = Yaw();
  yaw_ += AngleDifference(yaw, yaw_);
  distance_ += std::abs(Speed()) * model_->opt.timestep;
}

/// Sets moving obstacles to their planned positions and speeds; a collision does not change the
/// motion of an obstacle.
void MujocoPlant::MoveObstacles() {
  const auto move = [&](const MovedJoint& joint, double position, double velocity) {
    data_->qpos[joint.qpos] = position;
    data_->qvel[joint.dof] = velocity;
  };
  for (const Mover& mover : movers_) {
    const ObstacleMotion motion = MotionAt(world_.obstacles[mover.obstacle], data_->time);
    move(mover.x, motion.displacement.x, motion.velocity.x());
    move(mover.y, motion.displacement.y, motion.velocity.y());
    if (mover.yaw) {
      move(*mover.yaw, motion.displacement.yaw, motion.yaw_rate);
    }
  }
}

std::vector<double> MujocoPlant::Configuration() const {
  return car_.ExtractConfiguration({data_->qpos, static_cast<std::size_t>(model_->nq)});
}

bool MujocoPlant::diverged() const {
  return std::any_of(std::begin(data_->warning), std::end(data_->warning),
                     [](const mjWarningStat& warning) { return warning.number > 0; });
}

std::string MujocoPlant::divergence() const {
  for (int kind = 0; kind < mjNWARNING; ++kind) {
    const mjWarningStat& warning = data_->warning[kind];
    if (warning.number > 0) {
      return fmt::format("MuJoCo: {}", mj::WarningText(kind, warning.lastinfo));
    }
  }
  return "";
}

double MujocoPlant::wheel_gap() const {
  double lowest = std::numeric_limits<double>::infinity();
  for (const int wheel : car_.wheels()) {
    const mjtNum* hub_W = data_->xpos + 3 * wheel;
    lowest = std::min(lowest, hub_W[2] - GroundHeight(world_, {hub_W[0], hub_W[1]}));
  }
  return lowest - car_.params().wheel_radius;
}

const mjtNum* MujocoPlant::ChassisPosition() const {
  return data_->qpos + car_.chassis().chassis_qpos;
}

const mjtNum* MujocoPlant::ChassisVelocity() const {
  return data_->qvel + car_.chassis().chassis_dof;
}

Matrix3d MujocoPlant::ChassisRotation() const {
  const mjtNum* q = ChassisPosition() + 3;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

double MujocoPlant::Yaw() const {
  const mjtNum* q = ChassisPosition() + 3;
  return std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
}

/// Returns the unit vector along the car's heading, equal to Direction(Yaw()).
Vec2 MujocoPlant::Ahead() const {
  const mjtNum* q = ChassisPosition() + 3;
  return Vec2(1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]), 2.0 * (q[0] * q[3] + q[1] * q[2]))
      .normalized();
}

double MujocoPlant::Speed() const {
  const Vec2 ahead = Ahead();
  const mjtNum* v = ChassisVelocity();
  return ahead.x() * v[0] + ahead.y() * v[1];
}

double MujocoPlant::Drag() const {
  const Vector3d air_V = ChassisRotation().transpose() * AirSpeed();
  return -0.5 * kAirDensity * air_V.norm() * air_V.x() * car_.chassis().aerodynamics.drag_area;
}

/// Returns the road's friction factor under each wheel, and sets the friction of the tyre contacts
/// accordingly.
MujocoPlant::Road MujocoPlant::UpdateRoadFriction() {
  const std::span<const int> wheels = car_.wheels();
  Road road{};
  for (std::size_t w = 0; w < wheels.size(); ++w) {
    const mjtNum* hub = data_->xpos + 3 * wheels[w];
    road[w] = RoadFactor(world_, {hub[0], hub[1]});
    // Only the coefficient of sliding friction is scaled by the road's friction factor. The
    // coefficients of torsional and rolling friction are lengths, which do not depend on the road.
    model_->geom_friction[3 * car_.tyres()[w]] = tyre_friction_[w] * road[w];
  }
  if (const std::optional<TrailerParts>& trailer = car_.trailer()) {
    for (std::size_t w = 0; w < trailer_road_.size(); ++w) {
      const mjtNum* hub = data_->xpos + 3 * trailer->wheel[w];
      trailer_road_[w] = RoadFactor(world_, {hub[0], hub[1]});
      model_->geom_friction[3 * trailer->tyre[w]] = trailer_friction_ * trailer_road_[w];
    }
  }
  return road;
}

/// Returns the velocity of the air relative to the car, in the world frame [m/s].
Vector3d MujocoPlant::AirSpeed() const {
  const mjtNum* at = ChassisPosition();
  const Vec2 wind = WindAt(world_, {at[0], at[1]}, data_->time);
  return Vector3d(wind.x(), wind.y(), 0.0) - Vec(ChassisVelocity());
}

void MujocoPlant::ApplyAirForce() {
  const CarAerodynamics& car = car_.chassis().aerodynamics;
  const Matrix3d R_WV = ChassisRotation();
  const Vector3d air_V = R_WV.transpose() * AirSpeed();
  const double pressure = 0.5 * kAirDensity * air_V.head<2>().norm();
  const Vector3d force_W = R_WV * Vector3d(pressure * air_V.x() * car.drag_area,
                                           pressure * air_V.y() * car.side_area, 0.0);
  const Vector3d at_W = Vec(ChassisPosition()) +
                        R_WV * Vector3d(car.center_of_pressure[0], 0.0, car.center_of_pressure[1]);
  AddForce(*model_, *data_, car_.chassis().chassis, at_W, force_W);
}

void MujocoPlant::ApplyLateralForce(double force) {
  TRACKBED_REQUIRE(std::isfinite(force), "ApplyLateralForce: {} N; must be finite", force);
  pending_lateral_force_ = force;
}

void MujocoPlant::ApplyLateralOffset(double left) {
  TRACKBED_REQUIRE(std::isfinite(left), "ApplyLateralOffset: {} m; must be finite", left);
  mjtNum* at = data_->qpos + car_.chassis().chassis_qpos;
  const Vec2 from(at[0], at[1]);
  const Vec2 to = from + left * LeftNormal(Ahead());
  at[0] = to.x();
  at[1] = to.y();
  at[2] += GroundHeight(world_, to) - GroundHeight(world_, from);
}

void MujocoPlant::ApplyPendingLateralForce() {
  if (pending_lateral_force_ == 0.0) {
    return;
  }
  const Vec2 force = pending_lateral_force_ * LeftNormal(Ahead());
  const Vector3d force_W(force.x(), force.y(), 0.0);
  const int chassis = car_.chassis().chassis;
  const Vector3d cg_V(car_.params().cg_to_rear, 0.0, car_.chassis().cg_height);
  // In MuJoCo, the subtree of the chassis also contains the trailer.
  const Vector3d cg_W = car_.trailer() ? Vec(ChassisPosition()) + ChassisRotation() * cg_V
                                       : Vec(data_->subtree_com + 3 * chassis);
  AddForce(*model_, *data_, chassis, cg_W, force_W);
  pending_lateral_force_ = 0.0;
}

VehicleState MujocoPlant::Observe() const {
  const VehicleParams& params = car_.params();
  const mjtNum* position = ChassisPosition();
  const Matrix3d R_WV = ChassisRotation();
  // Computes the velocity of the origin of the vehicle frame V.
  const Vector3d v_W = Vec(ChassisVelocity());
  // MuJoCo stores the angular velocity of a free joint in the body's frame.
  const Vector3d w_W = R_WV * Vec(ChassisVelocity() + 3);
  const mjtNum* qacc = data_->qacc + car_.chassis().chassis_dof;
  const Vector3d a_W = Vec(qacc);
  const Vector3d alpha_W = R_WV * Vec(qacc + 3);
  // In the returned state, pose and velocities refer to points at ground height, whereas
  // accelerations refer to the center of gravity.
  const Vector3d v_cg_W = v_W + w_W.cross(R_WV * Vector3d(params.cg_to_rear, 0.0, 0.0));
  const Vector3d to_cg_W = R_WV * Vector3d(params.cg_to_rear, 0.0, car_.chassis().cg_height);
  const Vector3d a_cg_W = a_W + alpha_W.cross(to_cg_W) + w_W.cross(w_W.cross(to_cg_W));

  const Vec2 ahead = Ahead();
  const Vec2 left = LeftNormal(ahead);
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
  // At rest, the sideslip angle is set to 0, because a computed value would consist only of
  // rounding errors.
  state.sideslip =
      v_cg_W.head<2>().norm() < kAtRestSpeed ? 0.0 : std::atan(state.lateral_speed / cg_speed);
  const Wheels wheels = ObserveWheels();
  state.steering_actuator = wheels.actuator;
  state.steering = wheels.steering;
  state.wheels = wheels.forces;
  state.obstacle_force = obstacle_force();
  return state;
}

MujocoPlant::PlanarMotion MujocoPlant::Motion() const {
  const Matrix3d R_WV = ChassisRotation();
  const Vector3d v_W = Vec(ChassisVelocity());
  const Vector3d w_W = R_WV * Vec(ChassisVelocity() + 3);
  const Vector3d v_cg_W = v_W + w_W.cross(R_WV * Vector3d(car_.params().cg_to_rear, 0.0, 0.0));
  const Vec2 ahead = Ahead();
  const Vec2 cg(ahead.dot(v_cg_W.head<2>()), LeftNormal(ahead).dot(v_cg_W.head<2>()));
  return {.speed = ahead.dot(v_W.head<2>()),
          .yaw_rate = w_W.z(),
          .sideslip = cg.norm() < kAtRestSpeed ? 0.0 : std::atan(cg.y() / cg.x())};
}

std::optional<TrailerState> MujocoPlant::trailer() const {
  const std::optional<TrailerParts>& trailer = car_.trailer();
  if (!trailer) {
    return std::nullopt;
  }
  return TrailerState{.angle = data_->qpos[trailer->hitch_qpos[0]],
                      .rate = data_->qvel[trailer->hitch_dof[0]],
                      .lean = std::acos(std::clamp(data_->xmat[9 * trailer->body + 8], -1.0, 1.0))};
}

Pose2 MujocoPlant::pose() const {
  const mjtNum* position = ChassisPosition();
  return {position[0], position[1], yaw_};
}

double MujocoPlant::obstacle_force() const {
  double sum = 0.0;
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    const auto is = [&](const std::vector<bool>& kind, int geom) {
      return kind[static_cast<std::size_t>(geom)];
    };
    // Only contacts between an obstacle and the car are collisions.
    if ((is(is_obstacle_, contact.geom1) && is(is_of_car_, contact.geom2)) ||
        (is(is_obstacle_, contact.geom2) && is(is_of_car_, contact.geom1))) {
      std::array<mjtNum, 6> force{};
      mj_contactForce(model_.get(), data_.get(), i, force.data());
      sum += force[0];
    }
  }
  return sum;
}

std::unique_ptr<Plant> MakeMujocoPlant(const PlantSetup& setup) {
  return setup.car.params().kind == VehicleKind::kDifferential ? MakeWheelPairPlant(setup)
                                                               : MakeCarPlant(setup);
}

}  // namespace trackbed
