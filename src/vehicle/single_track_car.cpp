#include "trackbed/vehicle/single_track_car.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "src/vehicle/lateral_offset.h"
#include "src/vehicle/motion.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr double kMaxStep = 0.002;  // [s]

/// Coefficients of the integrator Radau IIA with three stages (Hairer and Wanner 1996, IV.5). The
/// last stage of Radau IIA is the end of the step.
struct Radau {
  Eigen::Vector3d node;
  Eigen::Matrix3d weight;
};

const Radau& RadauIIA() {
  static const Radau radau = [] {
    const double root = std::sqrt(6.0);
    Radau r;
    r.node << (4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0;
    r.weight << (88.0 - 7.0 * root) / 360.0, (296.0 - 169.0 * root) / 1800.0,
        (-2.0 + 3.0 * root) / 225.0, (296.0 + 169.0 * root) / 1800.0, (88.0 + 7.0 * root) / 360.0,
        (-2.0 - 3.0 * root) / 225.0, (16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0;
    return r;
  }();
  return radau;
}

}  // namespace

SingleTrackState RollingWithoutSlip(const VehicleParams& params, const KinematicState& state) {
  const double yaw_rate = state.speed * CurvatureForSteering(params, state.steering);
  return {.pose = state.pose,
          .speed = state.speed,
          .lateral_speed = params.cg_to_rear * yaw_rate,
          .yaw_rate = yaw_rate,
          .steering = state.steering,
          .distance = state.distance};
}

SingleTrackCar::SingleTrackCar(const VehicleParams& params, const SingleTrackState& start)
    : params_(params), state_(start) {
  const double front = params.cornering_stiffness_front;
  const double rear = params.cornering_stiffness_rear;
  TRACKBED_CHECK(params.mass > 0.0 && params.yaw_inertia > 0.0 && front > 0.0 && rear > 0.0,
                 "{} has no mass, yaw inertia or cornering stiffness", params.name);
  if (start.speed == 0.0) {
    state_.lateral_speed = 0.0;
    state_.yaw_rate = 0.0;
  }
  const double l_f = params.cg_to_front();
  const double l_r = params.cg_to_rear;
  const double moment = l_f * front - l_r * rear;
  slip_rate_ << (front + rear) / params.mass, moment / params.mass, moment / params.yaw_inertia,
      (l_f * l_f * front + l_r * l_r * rear) / params.yaw_inertia;
  steer_gain_ << front / params.mass, l_f * front / params.yaw_inertia;
}

void SingleTrackCar::Step(const Command& command, double duration) {
  const Motion motion = MotionUnder(command, params_, state_.steering, state_.speed, duration);
  for (const MotionPiece& piece : motion.pieces) {
    if (piece.duration > 0.0) {
      Advance(piece);
    }
  }
  time_ += duration;
  acceleration_ = motion.acceleration;
}

void SingleTrackCar::ApplyLateralOffset(double left) {
  ApplyLateralOffsetTo(state_.pose, left);
}

void SingleTrackCar::ApplyLateralForce(double impulse) {
  TRACKBED_REQUIRE(std::isfinite(impulse), "ApplyLateralForce: {} N s; must be finite", impulse);
  if (state_.speed != 0.0) {
    state_.lateral_speed += impulse / params_.mass;
  }
}

void SingleTrackCar::Advance(const MotionPiece& piece) {
  if (state_.speed == 0.0 && piece.acceleration == 0.0) {
    state_.steering = piece.end_steering;
    return;
  }
  const double steps = std::max(1.0, std::ceil(piece.duration / kMaxStep));
  MotionPiece part = piece;
  part.duration = piece.duration / steps;
  const double start_speed = state_.speed;
  const double start_steering = state_.steering;
  for (double i = 1.0; i <= steps; i += 1.0) {
    const bool last = i == steps;
    const double time = i * part.duration;
    part.end_speed = last ? piece.end_speed : start_speed + piece.acceleration * time;
    part.end_steering = last ? piece.end_steering : start_steering + piece.steering_rate * time;
    StepByRadau(part);
  }
}

/// Returns the matrix Decay of the equations of motion |u| z' = B tan(delta) - Decay z. The vector
/// z = (v/u, r/u) contains the ratios of lateral speed v and yaw rate r to the forward speed u.
Eigen::Matrix2d SingleTrackCar::Decay(double speed, double acceleration_along) const {
  Eigen::Matrix2d decay = slip_rate_ + acceleration_along * Eigen::Matrix2d::Identity();
  decay(0, 1) += speed * std::abs(speed);
  return decay;
}

/// Returns the ratios of lateral speed and yaw rate to the forward speed. At rest, returns the only
/// finite limit of these ratios, which applies when the car comes to rest or starts to move.
SingleTrackCar::Ratios SingleTrackCar::RatiosAt(double direction, double acceleration) const {
  if (state_.speed != 0.0) {
    return Ratios(state_.lateral_speed, state_.yaw_rate) / state_.speed;
  }
  return Decay(0.0, direction * acceleration).inverse() * steer_gain_ * std::tan(state_.steering);
}

void SingleTrackCar::StepByRadau(const MotionPiece& piece) {
  const Radau& radau = RadauIIA();
  const double h = piece.duration;
  // Within a step of this integrator, the speed does not change its sign.
  const double direction = std::copysign(1.0, state_.speed + piece.end_speed);
  const Ratios start = RatiosAt(direction, piece.acceleration);

  // Solve the stage equations of Radau IIA for the time derivatives f_i of the speed ratios z at
  // the stages i: |u_i| f_i + Decay_i h sum_j w_ij f_j = B tan(delta_i) - Decay_i z_0, with the
  // step h and the weights w_ij.
  Eigen::Matrix<double, 6, 6> matrix;
  Eigen::Matrix<double, 6, 1> right;
  Eigen::Vector3d speed;
  for (int i = 0; i < 3; ++i) {
    const double time = radau.node[i] * h;
    const bool last = i == 2;
    speed[i] = last ? piece.end_speed : state_.speed + piece.acceleration * time;
    const double steering =
        last ? piece.end_steering : state_.steering + piece.steering_rate * time;
    const Eigen::Matrix2d decay = Decay(speed[i], direction * piece.acceleration);
    for (int j = 0; j < 3; ++j) {
      matrix.block<2, 2>(2 * i, 2 * j) = h * radau.weight(i, j) * decay;
    }
    matrix.block<2, 2>(2 * i, 2 * i) += std::abs(speed[i]) * Eigen::Matrix2d::Identity();
    right.segment<2>(2 * i) = steer_gain_ * std::tan(steering) - decay * start;
  }
  const Eigen::Matrix<double, 6, 1> solution = matrix.partialPivLu().solve(right);
  const Eigen::Matrix<double, 2, 3> slopes =
      Eigen::Map<const Eigen::Matrix<double, 2, 3>>(solution.data());
  const Eigen::Matrix<double, 2, 3> ratios =
      (h * slopes * radau.weight.transpose()).colwise() + start;

  const Eigen::Vector3d yaw_rate = speed.cwiseProduct(ratios.row(1).transpose());
  const Eigen::Vector3d turn = h * radau.weight * yaw_rate;
  Vec2 shift = Vec2::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vec2 ahead = Direction(state_.pose.yaw + turn[i]);
    const double rear_slip = ratios(0, i) - params_.cg_to_rear * ratios(1, i);
    shift += h * radau.weight(2, i) * speed[i] * (ahead + rear_slip * LeftNormal(ahead));
  }
  state_.distance += 0.5 * std::abs(state_.speed + piece.end_speed) * h;
  state_.pose = {state_.pose.x + shift.x(), state_.pose.y + shift.y(), state_.pose.yaw + turn[2]};
  state_.speed = piece.end_speed;
  state_.steering = piece.end_steering;
  state_.lateral_speed = piece.end_speed * ratios(0, 2);
  state_.yaw_rate = yaw_rate[2];
}

VehicleState SingleTrackCar::FullState() const {
  VehicleState full;
  full.time = time_;
  full.pose = state_.pose;
  full.speed = state_.speed;
  full.distance = state_.distance;
  full.lateral_speed = state_.lateral_speed;
  full.yaw_rate = state_.yaw_rate;
  full.longitudinal_acceleration = acceleration_ - state_.lateral_speed * state_.yaw_rate;
  full.steering_actuator = state_.steering;
  full.steering = state_.steering;
  if (state_.speed != 0.0 || acceleration_ != 0.0) {
    // Compute the lateral acceleration (F_f + F_r)/m from the lateral tyre forces of the front and
    // rear axles. If the car has just come to rest, its previous motion was opposite to its
    // acceleration.
    const double direction =
        std::copysign(1.0, state_.speed != 0.0 ? state_.speed : -acceleration_);
    const Ratios ratios = RatiosAt(direction, acceleration_);
    full.lateral_acceleration =
        direction * (steer_gain_ * std::tan(state_.steering) - slip_rate_ * ratios).x();
    full.sideslip = state_.speed == 0.0 ? 0.0 : std::atan(ratios.x());
  }
  return full;
}

}  // namespace trackbed
