#include "src/control/tracking.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/control/brush_axle.h"
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

Eigen::Matrix<double, 2, 3> LateralRates(const VehicleParams& vehicle,
                                         const CorneringStiffness& stiffness, double speed) {
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

namespace {

/// Returns the steady turn with the given slip angles of the axles [rad]. The slip angle of an axle
/// is the axle's lateral velocity divided by |u|, positive to the left.
SteadyTurn TurnWithSlip(const VehicleParams& vehicle, double curvature, double speed,
                        double front_slip, double rear_slip) {
  const double direction = std::copysign(1.0, speed);
  SteadyTurn turn;
  turn.yaw_rate = speed * curvature;
  turn.heading_error = -direction * rear_slip;
  turn.lateral_speed = vehicle.cg_to_rear * turn.yaw_rate + std::abs(speed) * rear_slip;
  turn.steering = std::atan(vehicle.wheelbase * curvature + direction * (rear_slip - front_slip));
  return turn;
}

/// Computes the slip angles and the stiffness of the front and rear axle by the brush model.
std::array<AxleOperation, 2> BrushAxles(const VehicleParams& vehicle, const Motion& motion) {
  const bool brakes = motion.acceleration < 0.0;
  const AccelerationLimit& limit = brakes ? vehicle.braking : vehicle.driving;
  const double hard = std::abs(motion.acceleration);
  const double direction = std::copysign(1.0, motion.speed);
  const double lateral = vehicle.mass * motion.speed * motion.speed * motion.curvature;
  const std::array<double, 2> stiffness{vehicle.cornering_stiffness_front,
                                        vehicle.cornering_stiffness_rear};
  std::array<AxleOperation, 2> axles;
  for (std::size_t i = 0; i < axles.size(); ++i) {
    constexpr double kMinLoad = 0.05;  // minimum load of an axle as a fraction of the load at rest
    const AxleGrip& axle = limit.axles[i];
    const double load =
        std::max(kMinLoad, 1.0 + direction * axle.transfer * hard / (kGravity * axle.weight));
    const double weight = vehicle.mass * kGravity * axle.weight;
    // In a steady turn, each axle carries the same fraction of the lateral force as of the weight.
    axles[i] = BrushAxleAt(
        load * stiffness[i], vehicle.friction_lateral * load * weight,
        {.longitudinal = vehicle.mass * axle.force * hard, .lateral = lateral * axle.weight});
  }
  return axles;
}

bool KnowsBrushAxles(const VehicleParams& vehicle) {
  return vehicle.friction_lateral > 0.0 && vehicle.braking.axles.size() == 2 &&
         vehicle.driving.axles.size() == 2;
}

}  // namespace

SteadyTurn SteadyTurnOn(const VehicleParams& vehicle, double curvature, double speed) {
  if (!HasTyres(vehicle)) {
    return TurnWithSlip(vehicle, curvature, speed, 0.0, 0.0);
  }
  // Each axle's share of the force m u r is proportional to the distance of the other axle from the
  // center of gravity.
  const double force = vehicle.mass * speed * speed * curvature / vehicle.wheelbase;
  return TurnWithSlip(vehicle, curvature, speed,
                      -vehicle.cg_to_rear * force / vehicle.cornering_stiffness_front,
                      -vehicle.cg_to_front() * force / vehicle.cornering_stiffness_rear);
}

TurnOperation OperateOn(const VehicleParams& vehicle, TyreForces tyres, const Motion& motion) {
  if (tyres == TyreForces::kNone) {
    return {TurnWithSlip(vehicle, motion.curvature, motion.speed, 0.0, 0.0), {}};
  }
  if (tyres == TyreForces::kBrush && HasTyres(vehicle) && KnowsBrushAxles(vehicle)) {
    const auto [front, rear] = BrushAxles(vehicle, motion);
    return {TurnWithSlip(vehicle, motion.curvature, motion.speed, -front.slip, -rear.slip),
            {front.stiffness, rear.stiffness}};
  }
  return {SteadyTurnOn(vehicle, motion.curvature, motion.speed),
          {vehicle.cornering_stiffness_front, vehicle.cornering_stiffness_rear}};
}

}  // namespace trackbed
