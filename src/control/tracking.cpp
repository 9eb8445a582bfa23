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

bool RearAxleSlips(const ControlInput& input) {
  constexpr double kRounding = 1e-9;
  const double turning = input.vehicle.cg_to_rear * input.state.yaw_rate;
  return std::abs(input.state.lateral_speed - turning) > kRounding * (1.0 + std::abs(turning));
}

CarScale ComputeCarScale(const VehicleParams& vehicle) {
  constexpr double kWheelbase = 2.7;             // [m]
  constexpr double kSteeringRate = 2.65 / 17.6;  // [rad/s]
  return {.length = vehicle.wheelbase / kWheelbase, .time = kSteeringRate / vehicle.steering_rate};
}

Eigen::Matrix<double, 2, 3> LateralRates(const VehicleParams& vehicle,
                                         const AxleStiffness& stiffness, double speed) {
  const auto [front, rear] = stiffness;
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

TurnOperation OperateOn(const VehicleParams& vehicle, TyreForces tyres, const Motion& motion) {
  switch (tyres) {
    case TyreForces::kNone:
      return {TurnWithoutSlip(vehicle, motion.curvature, motion.speed), {}};
    case TyreForces::kLinear:
      return {SteadyTurnOn(vehicle, motion.curvature, motion.speed),
              {vehicle.cornering_stiffness_front, vehicle.cornering_stiffness_rear}};
    case TyreForces::kBrush:
      break;
  }
  return BrushTurnOn(vehicle, motion);
}

}  // namespace trackbed
