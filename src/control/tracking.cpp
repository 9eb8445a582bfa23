#include "src/control/tracking.h"

#include <cmath>

#include "trackbed/core/angle.h"

namespace trackbed {

Tracking ProjectOntoPath(const ControlInput& input) {
  Tracking tracking;
  tracking.foot = input.reference.path.At(input.station);
  const Pose2& pose = input.state.pose;
  tracking.cross_track = ToLocal(tracking.foot.pose, pose.position()).y();
  tracking.heading_error = AngleDifference(pose.yaw, tracking.foot.pose.yaw);
  return tracking;
}

CarScale ComputeCarScale(const VehicleParams& vehicle) {
  constexpr double kWheelbase = 2.7;             // [m]
  constexpr double kSteeringRate = 2.65 / 17.6;  // [rad/s]
  return {.length = vehicle.wheelbase / kWheelbase, .time = kSteeringRate / vehicle.steering_rate};
}

bool HasTyres(const VehicleParams& vehicle) {
  return vehicle.mass > 0.0 && vehicle.yaw_inertia > 0.0 &&
         vehicle.cornering_stiffness_front > 0.0 && vehicle.cornering_stiffness_rear > 0.0;
}

Eigen::Matrix<double, 2, 3> LateralRates(const VehicleParams& vehicle, double speed) {
  const double front = vehicle.cornering_stiffness_front;
  const double rear = vehicle.cornering_stiffness_rear;
  const double l_f = vehicle.cg_to_front();
  const double l_r = vehicle.cg_to_rear;
  const double moment = l_f * front - l_r * rear;
  const double direction = std::copysign(1.0, speed);
  const double mass = vehicle.mass * std::abs(speed);
  const double inertia = vehicle.yaw_inertia * std::abs(speed);
  Eigen::Matrix<double, 2, 3> rates;
  rates << -(front + rear) / mass, -moment / mass - speed, direction * front / vehicle.mass,
      -moment / inertia, -(l_f * l_f * front + l_r * l_r * rear) / inertia,
      direction * l_f * front / vehicle.yaw_inertia;
  return rates;
}

SteadyTurn SteadyTurnOn(const VehicleParams& vehicle, double curvature, double speed) {
  SteadyTurn turn;
  turn.yaw_rate = speed * curvature;
  turn.lateral_speed = vehicle.cg_to_rear * turn.yaw_rate;
  if (!HasTyres(vehicle)) {
    turn.steering = SteeringForCurvature(vehicle, curvature);
    return turn;
  }
  // Each axle carries the other's share of m u r.
  const double force = vehicle.mass * speed * turn.yaw_rate / vehicle.wheelbase;
  const double rear_slip =
      -vehicle.cg_to_front() * force / vehicle.cornering_stiffness_rear;  // of |u|, to the left
  const double front_slip = -vehicle.cg_to_rear * force / vehicle.cornering_stiffness_front;
  const double direction = std::copysign(1.0, speed);
  turn.heading_error = -direction * rear_slip;
  turn.lateral_speed += std::abs(speed) * rear_slip;
  turn.steering = std::atan(vehicle.wheelbase * curvature + direction * (rear_slip - front_slip));
  return turn;
}

}  // namespace trackbed
