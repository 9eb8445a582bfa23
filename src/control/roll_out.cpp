#include "src/control/roll_out.h"

#include <cmath>
#include <limits>

#include "src/control/steering_limit.h"
#include "src/control/turn_round.h"
#include "trackbed/core/angle.h"

// Simulates the single-track car for MPPI:
//   1. Before the roll-outs of a control period, sample the path, its steady turns and its edges at
//      nodes. Compute the planned speed and the axle forces of each roll-out step. Compute the lqr
//      regulator, which gives the cost beyond the horizon, and find the obstacles nearby.
//   2. In each step of a roll-out, turn the actuator and the wheels. Solve the lateral motion by
//      the implicit Euler method with secant tyre stiffnesses, which is stable at any speed. Move
//      the rear axle on an arc, and project its position onto the path between two nodes.
//   3. After each step of a roll-out, add the cost of the deviation from the path, of the lateral
//      acceleration, and of small clearances.
namespace trackbed {
namespace {

/// Cost of a collision per step. The cost of a collision exceeds the cost of any deviation from the
/// path during a detour.
constexpr double kCollision = 1e4;
/// Cost per step of a car that touches an obstacle. This cost falls to 0 as the gap to the obstacle
/// grows to the margin.
constexpr double kCloseness = 20.0;
/// Cost of a lateral acceleration of twice the grip.
constexpr double kBeyondGrip = 1e3;
/// Angle [rad] at which a car with the controller lqr approaches its path from far away
/// (ScheduledRegulator).
constexpr double kApproachAngle = 0.6;

double Between(double a, double b, double share) {
  return a + share * (b - a);
}

}  // namespace

void RollOuts::Prepare(const ControlInput& input, const Tracking& tracking, double actuator,
                       const Surroundings* surroundings, const RollOutSettings& settings) {
  settings_ = settings;
  vehicle_ = input.vehicle;
  direction_ = tracking.foot.direction;
  slips_ = HasTyres(vehicle_);
  rate_limit_ = vehicle_.steering_rate;
  lag_ = vehicle_.steering_delay();
  lag_decay_ = lag_ > 0.0 ? std::exp(-settings.step / lag_) : 0.0;
  const Vec2 at = ToLocal(tracking.foot.pose, input.state.pose.position());
  start_ = {.x = at.x(),
            .y = at.y(),
            .yaw = tracking.heading_error,
            .lateral_speed = input.state.lateral_speed,
            .yaw_rate = input.state.yaw_rate,
            .actuator = actuator,
            .wheels = input.state.steering};
  PrepareStages(input);
  PrepareNodes(input, tracking, surroundings);
  Project(start_);
  PrepareRegulator(input, tracking);
  PrepareObstacles(tracking, surroundings);
}

RollOuts::Stage RollOuts::StageAt(double speed, double acceleration) const {
  Stage stage{.speed = speed,
              .stiffness = {vehicle_.cornering_stiffness_front, vehicle_.cornering_stiffness_rear},
              .friction_force = {std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity()}};
  const AccelerationLimit& limit = acceleration < 0.0 ? vehicle_.braking : vehicle_.driving;
  if (vehicle_.friction_lateral <= 0.0 || limit.axles.size() != 2) {
    return stage;
  }
  const double hard = std::abs(acceleration);
  for (std::size_t i = 0; i < 2; ++i) {
    constexpr double kMinShare =
        0.05;  // lower bound of load / static load and of lateral force / friction force
    const AxleGrip& axle = limit.axles[i];
    const double load =
        std::max(kMinShare, 1.0 + direction_ * axle.transfer * hard / (kGravity * axle.weight));
    const double normal = load * vehicle_.mass * kGravity * axle.weight;
    const double use = vehicle_.mass * axle.force * hard /
                       (std::max(vehicle_.friction_longitudinal, kMinShare) * normal);
    stage.stiffness[i] *= load;
    stage.friction_force[i] = vehicle_.friction_lateral * normal *
                              std::max(kMinShare, std::sqrt(std::max(0.0, 1.0 - use * use)));
  }
  return stage;
}

void RollOuts::PrepareStages(const ControlInput& input) {
  const SpeedProfile& planned = input.reference.speed;
  grip_ = settings_.grip * LateralGrip(vehicle_);
  const double now = std::max(direction_ * input.state.speed, 0.0);
  const double excess = now - planned.SpeedAt(input.station);
  const double decay = planned.knots().empty() ? 1.0 : std::exp(-input.speed_gain * settings_.step);
  double station = input.station;
  double speed = now;
  double left = excess;
  stages_.resize(static_cast<std::size_t>(settings_.steps));
  for (Stage& stage : stages_) {
    const double acceleration = planned.AccelerationAt(station);
    station += speed * settings_.step +
               0.5 * std::max(acceleration, 0.0) * settings_.step * settings_.step;
    left *= decay;
    speed = std::max(planned.SpeedAt(station) + left, 0.0);
    stage = StageAt(direction_ * speed, acceleration);
    stage.station = station - input.station;
  }
}

void RollOuts::PrepareNodes(const ControlInput& input, const Tracking& tracking,
                            const Surroundings* surroundings) {
  const double spare = std::max(vehicle_.length, vehicle_.wheelbase);
  const double ahead = stages_.back().station + spare;
  first_ = -spare;
  spacing_ = (ahead + spare) / (kNodes - 1);
  nodes_.resize(kNodes);
  const PathEdges* edges = nullptr;
  if (surroundings != nullptr && !surroundings->Edges().distances.empty()) {
    edges = &surroundings->Edges();
  }
  has_edges_ = edges != nullptr;
  const Pose2& foot = tracking.foot.pose;
  double last = 0.0;
  std::size_t stage = 0;
  for (int i = 0; i < kNodes; ++i) {
    const double station = first_ + i * spacing_;
    while (stage + 1 < stages_.size() && stages_[stage].station < station) {
      ++stage;
    }
    const PathPoint point = input.reference.path.At(input.station + station);
    Node& node = nodes_[static_cast<std::size_t>(i)];
    const Vec2 at = ToLocal(foot, point.pose.position());
    const double turned = AngleDifference(point.pose.yaw, foot.yaw);
    node.x = at.x();
    node.y = at.y();
    node.yaw = i == 0 ? turned : last + AngleDifference(turned, last);
    node.cosine = direction_ * std::cos(node.yaw);
    node.sine = direction_ * std::sin(node.yaw);
    if (i > 0) {
      nodes_[static_cast<std::size_t>(i) - 1].curvature = (node.yaw - last) / spacing_;
    }
    last = node.yaw;
    // Use the curvature at the path's end for the steady turn beyond that end, where the path is
    // straight. A car that stands at a cusp must steer for the start of its path.
    const double within = std::clamp(input.station + station, 0.0, input.reference.path.length());
    node.steady = OperateOn(vehicle_, slips_ ? TyreForces::kBrush : TyreForces::kNone,
                            {.curvature = input.reference.path.BendAt(within).curvature,
                             .speed = stages_[stage].speed})
                      .turn;
    if (has_edges_) {
      node.edges = edges->At(input.station + station);
    }
  }
  nodes_.back().curvature = 0.0;
}

void RollOuts::PrepareRegulator(const ControlInput& input, const Tracking& tracking) {
  const ErrorModel model = MakeErrorModel(input, tracking, settings_.step,
                                          slips_ ? TyreForces::kBrush : TyreForces::kNone);
  weights_ = settings_.weights;
  ErrorModel::Vector z = DeviationOf(start_);
  regulator_ = ScheduledRegulator(model, rate_limit_, weights_, z);
  largest_offset_ = kApproachAngle * std::abs(regulator_.gain[1]) / std::abs(regulator_.gain[0]);
}

void RollOuts::PrepareObstacles(const Tracking& tracking, const Surroundings* surroundings) {
  static const std::vector<SeenObstacle> none;
  const double reach = stages_.back().station + vehicle_.length + std::hypot(start_.x, start_.y);
  obstacles_.Take(surroundings != nullptr ? surroundings->Obstacles() : none, tracking.foot.pose,
                  reach, 0.5 * std::hypot(vehicle_.length, vehicle_.width), settings_.margin,
                  settings_.steps * settings_.step);
}

void RollOuts::Advance(int k, double rate, RolledCar& car) const {
  const double h = settings_.step;
  const double limit = vehicle_.steering_limit;
  const double actuator = std::clamp(car.actuator + rate * h, -limit, limit);
  const double slope = (actuator - car.actuator) / h;
  car.wheels = actuator - slope * lag_ + (car.wheels - car.actuator + slope * lag_) * lag_decay_;
  car.actuator = actuator;
  const Stage& stage = stages_[static_cast<std::size_t>(k)];
  const double speed = stage.speed;
  const double yaw_rate = car.yaw_rate;
  const double lateral_speed = car.lateral_speed;
  if (slips_) {
    Slide(stage, speed, car);
  } else {
    car.yaw_rate = speed * std::tan(car.wheels) / vehicle_.wheelbase;
    car.lateral_speed = vehicle_.cg_to_rear * car.yaw_rate;
  }
  car.lateral_acceleration =
      speed * car.yaw_rate + (slips_ ? (car.lateral_speed - lateral_speed) / h : 0.0);
  // The rear axle moves on an arc with the car's mean yaw rate during the roll-out step.
  const double turn = (slips_ ? 0.5 * (yaw_rate + car.yaw_rate) : car.yaw_rate) * h;
  const double across = car.lateral_speed - vehicle_.cg_to_rear * car.yaw_rate;
  const double chord = h * (1.0 - turn * turn / 24.0);
  const double middle = car.yaw + 0.5 * turn;
  const double cosine = std::cos(middle);
  const double sine = std::sin(middle);
  car.x += chord * (speed * cosine - across * sine);
  car.y += chord * (speed * sine + across * cosine);
  car.yaw += turn;
  car.station += std::abs(speed) * h;
  Project(car);
}

/// Solves the implicit Euler step of the lateral motion with the secant stiffness S of each axle.
/// The equations of motion are multiplied by the speed |u|, so that they also hold at rest:
///   m (v' + u r) = F_f + F_r,  I r' = l_f F_f - l_r F_r,
///   F_f = S_f (u tan(delta) - v - l_f r)/|u|,  F_r = -S_r (v - l_r r)/|u|.
void RollOuts::Slide(const Stage& stage, double speed, RolledCar& car) const {
  const double h = settings_.step;
  const double l_f = vehicle_.cg_to_front();
  const double l_r = vehicle_.cg_to_rear;
  const double fast = std::abs(speed);
  const double along = speed * std::tan(car.wheels);
  const double v = car.lateral_speed;
  const double r = car.yaw_rate;
  const auto secant = [&](std::size_t axle, double slipping) {
    const double stiffness = stage.stiffness[axle];
    const double friction = stage.friction_force[axle];
    const double q = stiffness * std::abs(slipping) / (3.0 * friction * fast);
    return q < 1.0 ? stiffness * (1.0 - q + q * q / 3.0) : stiffness / (3.0 * q);
  };
  const bool rolls = fast > 0.0;
  const double front = rolls ? secant(0, along - v - l_f * r) : stage.stiffness[0];
  const double rear = rolls ? secant(1, v - l_r * r) : stage.stiffness[1];
  const double of_mass = h / vehicle_.mass;
  const double of_inertia = h / vehicle_.yaw_inertia;
  const double moment = l_f * front - l_r * rear;
  const double a = fast + of_mass * (front + rear);
  const double b = of_mass * moment + h * speed * fast;
  const double c = of_inertia * moment;
  const double d = fast + of_inertia * (l_f * l_f * front + l_r * l_r * rear);
  const double p = fast * v + of_mass * front * along;
  const double q = fast * r + of_inertia * l_f * front * along;
  const double determinant = a * d - b * c;
  car.lateral_speed = (p * d - b * q) / determinant;
  car.yaw_rate = (a * q - c * p) / determinant;
}

double RollOuts::PlaceOf(double station) const {
  return std::clamp((station - first_) / spacing_, 0.0, kNodes - 1.0);
}

void RollOuts::Project(RolledCar& car) const {
  const Node& node = nodes_[static_cast<std::size_t>(PlaceOf(car.station))];
  // Station of the node.
  const double base = first_ + spacing_ * static_cast<double>(&node - nodes_.data());
  const double dx = car.x - node.x;
  const double dy = car.y - node.y;
  const double k = node.curvature;
  const double along = dx * node.cosine + dy * node.sine;
  const double aside = dy * node.cosine - dx * node.sine;
  // Bound the distance to the center of curvature: for a car beyond this center, the nearest point
  // of the circle would be on the opposite side.
  constexpr double kMinToCenter = 0.05;
  const double to_center = std::max(1.0 - k * aside, kMinToCenter);
  const double tangent = k * along / to_center;
  constexpr double kSmall = 1e-6;
  const double arc = std::abs(tangent) < kSmall ? along / to_center : std::atan(tangent) / k;
  const double offset = (2.0 * aside - k * (aside * aside + along * along)) /
                        (1.0 + std::sqrt(k * along * k * along + to_center * to_center));
  car.station = base + arc;
  car.cross_track = direction_ * offset;
  car.heading_error = car.yaw - (node.yaw + k * arc);
}

SteadyTurn RollOuts::SteadyAt(double station) const {
  const double place = PlaceOf(station);
  const auto i = static_cast<std::size_t>(place);
  const SteadyTurn& from = nodes_[i].steady;
  const SteadyTurn& to = nodes_[std::min(i + 1, nodes_.size() - 1)].steady;
  const double share = place - static_cast<double>(i);
  return {.steering = Between(from.steering, to.steering, share),
          .heading_error = Between(from.heading_error, to.heading_error, share),
          .lateral_speed = Between(from.lateral_speed, to.lateral_speed, share),
          .yaw_rate = Between(from.yaw_rate, to.yaw_rate, share)};
}

ErrorModel::Vector RollOuts::DeviationOf(const RolledCar& car) const {
  const SteadyTurn steady = SteadyAt(car.station);
  ErrorModel::Vector z(slips_ ? 6 : 4);
  z[0] = car.cross_track;
  z[1] = car.heading_error - steady.heading_error;
  z[2] = car.actuator - steady.steering;
  z[3] = car.wheels - steady.steering;
  if (slips_) {
    z[4] = car.lateral_speed - steady.lateral_speed;
    z[5] = car.yaw_rate - steady.yaw_rate;
  }
  return z;
}

double RollOuts::RegulatorRate(const RolledCar& car) const {
  ErrorModel::Vector z = DeviationOf(car);
  z[0] = std::clamp(z[0], -largest_offset_, largest_offset_);
  return -regulator_.gain.dot(z);
}

double RollOuts::GapToEdges(const RolledCar& car) const {
  const Node& node = nodes_[static_cast<std::size_t>(PlaceOf(car.station))];
  const double cosine = std::cos(car.heading_error);
  const double sine = std::sin(car.heading_error);
  const double half = 0.5 * vehicle_.width * std::abs(cosine);
  double gap = std::numeric_limits<double>::infinity();
  for (const double x : {vehicle_.length - vehicle_.rear_overhang, -vehicle_.rear_overhang}) {
    const double ahead = direction_ * x * cosine;
    // Offset of the middle of the car's front or rear end from the path, to the left of the
    // direction of motion.
    const double bend = node.curvature * direction_;
    const double offset = car.cross_track + x * sine - 0.5 * bend * ahead * ahead;
    const Node& beside = nodes_[static_cast<std::size_t>(PlaceOf(car.station + ahead))];
    gap = std::min({gap, beside.edges.left - offset - half, beside.edges.right + offset - half});
  }
  return gap;
}

double RollOuts::StageCost(int k, const RolledCar& car) const {
  double cost = 0.0;
  if (k + 1 < settings_.steps) {
    const double offset = std::abs(car.cross_track);
    const double near = std::min(offset, largest_offset_);
    const double place = PlaceOf(car.station);
    const auto i = static_cast<std::size_t>(place);
    const double steady = Between(nodes_[i].steady.heading_error,
                                  nodes_[std::min(i + 1, nodes_.size() - 1)].steady.heading_error,
                                  place - static_cast<double>(i));
    const double heading = car.heading_error - steady;
    cost =
        weights_.cross_track * near * (2.0 * offset - near) + weights_.heading * heading * heading;
  }
  const double beyond = std::abs(car.lateral_acceleration) / grip_ - 1.0;
  if (beyond > 0.0) {
    cost += kBeyondGrip * beyond * beyond;
  }
  return obstacles_.empty() && !has_edges_ ? cost : cost + ClosenessCost(k, car);
}

double RollOuts::ClosenessCost(int k, const RolledCar& car) const {
  double gap = std::numeric_limits<double>::infinity();
  if (!obstacles_.empty()) {
    const double middle = 0.5 * vehicle_.length - vehicle_.rear_overhang;
    const double cosine = std::cos(car.yaw);
    const double sine = std::sin(car.yaw);
    gap = obstacles_.Gap({.x = car.x + middle * cosine,
                          .y = car.y + middle * sine,
                          .cosine = cosine,
                          .sine = sine,
                          .half_length = 0.5 * vehicle_.length,
                          .half_width = 0.5 * vehicle_.width},
                         (k + 1) * settings_.step);
  }
  if (has_edges_) {
    gap = std::min(gap, GapToEdges(car));
  }
  if (gap < 0.0) {
    return kCloseness + kCollision * (1.0 - gap / vehicle_.width);
  }
  const double share = 1.0 - gap / std::max(settings_.margin, gap);
  return gap < settings_.margin ? kCloseness * share * share : 0.0;
}

double RollOuts::RemainingCost(const RolledCar& car) const {
  ErrorModel::Vector z = DeviationOf(car);
  const double offset = std::abs(z[0]);
  z[0] = std::clamp(z[0], -largest_offset_, largest_offset_);
  const double beyond = offset - std::abs(z[0]);
  return z.dot(regulator_.cost * z) + 2.0 * regulator_.cost(0, 0) * largest_offset_ * beyond;
}

}  // namespace trackbed
