#include "trackbed/vehicle/kinematic_car.h"

#include <cmath>

#include "src/vehicle/lateral_offset.h"
#include "src/vehicle/motion.h"
#include "trackbed/core/error.h"

namespace trackbed {

KinematicCar::KinematicCar(const VehicleParams& params, ReferencePoint reference,
                           const KinematicState& start)
    : params_(params), reference_(reference), state_(start) {}

double KinematicCar::Slip(double steering) const {
  return reference_ == ReferencePoint::kRearAxle
             ? 0.0
             : std::atan(params_.cg_to_rear * std::tan(steering) / params_.wheelbase);
}

KinematicCar::Rates KinematicCar::RatesAt(double yaw, double speed, double steering) const {
  const double slip = Slip(steering);
  return {speed * Direction(yaw + slip),
          speed * std::cos(slip) * CurvatureForSteering(params_, steering)};
}

void KinematicCar::Step(const Command& command, double duration) {
  const Motion motion = MotionUnder(command, params_, state_.steering, state_.speed, duration);
  for (const MotionPiece& piece : motion.pieces) {
    if (piece.duration > 0.0) {
      Advance(piece);
    }
  }
  time_ += duration;
  steering_rate_ = motion.steering_rate;
  acceleration_ = motion.acceleration;
}

void KinematicCar::ApplyLateralOffset(double left) {
  ApplyLateralOffsetTo(state_.pose, left);
}

void KinematicCar::Advance(const MotionPiece& piece) {
  const double duration = piece.duration;
  const double moved = (state_.speed + 0.5 * piece.acceleration * duration) * duration;
  if (moved != 0.0) {
    state_.pose = PoseAfter(piece, moved);
    state_.distance += std::abs(moved);
  }
  state_.speed = piece.end_speed;
  state_.steering = piece.end_steering;
}

Pose2 KinematicCar::PoseAfter(const MotionPiece& piece, double moved) const {
  if (piece.steering_rate == 0.0) {
    const double slip = Slip(state_.steering);
    const double turn = moved * std::cos(slip) * CurvatureForSteering(params_, state_.steering);
    return MoveOnArc(state_.pose, moved, turn, slip);
  }
  // Integrate position and yaw by the fourth-order Runge-Kutta method. The speed and the steering
  // angle of the step are known functions of time.
  const auto rates = [&](double time, double yaw) {
    return RatesAt(yaw, state_.speed + piece.acceleration * time,
                   state_.steering + piece.steering_rate * time);
  };
  const double duration = piece.duration;
  const double half = 0.5 * duration;
  const double yaw = state_.pose.yaw;
  const Rates k1 = rates(0.0, yaw);
  const Rates k2 = rates(half, yaw + half * k1.yaw_rate);
  const Rates k3 = rates(half, yaw + half * k2.yaw_rate);
  const Rates k4 = rates(duration, yaw + duration * k3.yaw_rate);
  const Vec2 shift =
      duration / 6.0 * (k1.velocity + 2.0 * k2.velocity + 2.0 * k3.velocity + k4.velocity);
  return {
      state_.pose.x + shift.x(), state_.pose.y + shift.y(),
      yaw + duration / 6.0 * (k1.yaw_rate + 2.0 * k2.yaw_rate + 2.0 * k3.yaw_rate + k4.yaw_rate)};
}

VehicleState KinematicCar::FullState() const {
  const double l_g = params_.cg_to_rear;
  const double slip = Slip(state_.steering);
  // Compute the speed of the rear axle and its derivative. If the reference point is the CG, the
  // speed of the rear axle is v cos(beta), where beta is the sideslip angle.
  const double tangent = std::tan(state_.steering);
  const double curvature = tangent / params_.wheelbase;
  const double curvature_rate = (1.0 + tangent * tangent) * steering_rate_ / params_.wheelbase;
  double speed = state_.speed;
  double acceleration = acceleration_;
  Pose2 pose = state_.pose;
  if (reference_ == ReferencePoint::kCenterOfGravity) {
    const double cosine = std::cos(slip);
    const double slip_rate = l_g * curvature_rate * cosine * cosine;
    speed = state_.speed * cosine;
    acceleration = acceleration_ * cosine - state_.speed * std::sin(slip) * slip_rate;
    const Vec2 rear = ToWorld(state_.pose, {-l_g, 0.0});
    pose.x = rear.x();
    pose.y = rear.y();
  }
  const double yaw_rate = speed * curvature;
  const double yaw_acceleration = acceleration * curvature + speed * curvature_rate;

  VehicleState full;
  full.time = time_;
  full.pose = pose;
  full.speed = speed;
  full.distance = state_.distance;
  full.lateral_speed = l_g * yaw_rate;
  full.yaw_rate = yaw_rate;
  full.longitudinal_acceleration = acceleration - l_g * yaw_rate * yaw_rate;
  full.lateral_acceleration = speed * yaw_rate + l_g * yaw_acceleration;
  full.sideslip = speed == 0.0 ? 0.0 : std::atan(l_g * curvature);
  full.steering_actuator = state_.steering;
  full.steering = state_.steering;
  return full;
}

}  // namespace trackbed
