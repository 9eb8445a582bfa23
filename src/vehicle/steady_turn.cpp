#include "trackbed/vehicle/steady_turn.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/vehicle/brush_axle.h"

namespace trackbed {
namespace {

/// Returns the steady turn with the given slip angles of the axles [rad]. The slip angle of an axle
/// is the axle's lateral velocity (positive to the left) divided by the magnitude |u| of the
/// forward speed.
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
std::array<AxleOperation, 2> BrushAxles(const VehicleParams& vehicle, const TurnMotion& motion) {
  const bool brakes = motion.acceleration < 0.0;
  const AccelerationLimit& limit = brakes ? vehicle.braking : vehicle.driving;
  const double hard = std::abs(motion.acceleration);
  const double direction = std::copysign(1.0, motion.speed);
  const double lateral = vehicle.mass * motion.speed * motion.speed * motion.curvature;
  const double friction = vehicle.friction_lateral * motion.road;
  const std::array<double, 2> stiffness{vehicle.cornering_stiffness_front,
                                        vehicle.cornering_stiffness_rear};
  std::array<AxleOperation, 2> axles;
  for (std::size_t i = 0; i < axles.size(); ++i) {
    constexpr double kMinLoad = 0.05;  // minimum load of an axle as a fraction of its load at rest
    const AxleGrip& axle = limit.axles[i];
    const double load =
        std::max(kMinLoad, 1.0 + direction * axle.transfer * hard / (kGravity * axle.weight));
    const double weight = vehicle.mass * kGravity * axle.weight;
    // In a steady turn, each axle carries the same fraction of the lateral force as of the weight.
    axles[i] = BrushAxleAt(
        load * stiffness[i], friction * load * weight,
        {.longitudinal = vehicle.mass * axle.force * hard, .lateral = lateral * axle.weight});
  }
  return axles;
}

bool KnowsBrushAxles(const VehicleParams& vehicle) {
  return vehicle.friction_lateral > 0.0 && vehicle.braking.axles.size() == 2 &&
         vehicle.driving.axles.size() == 2;
}

TurnMotion AtConstantSpeed(const BendMotion& motion) {
  return {.curvature = motion.curvature, .speed = motion.speed, .road = motion.road};
}

}  // namespace

bool HasTyres(const VehicleParams& vehicle) {
  return vehicle.mass > 0.0 && vehicle.yaw_inertia > 0.0 &&
         vehicle.cornering_stiffness_front > 0.0 && vehicle.cornering_stiffness_rear > 0.0;
}

SteadyTurn TurnWithoutSlip(const VehicleParams& vehicle, double curvature, double speed) {
  return TurnWithSlip(vehicle, curvature, speed, 0.0, 0.0);
}

SteadyTurn SteadyTurnOn(const VehicleParams& vehicle, double curvature, double speed) {
  if (!HasTyres(vehicle)) {
    return TurnWithoutSlip(vehicle, curvature, speed);
  }
  // Each axle's share of the lateral force m u r (mass, forward speed, yaw rate) is proportional to
  // the distance of the other axle from the center of gravity.
  const double force = vehicle.mass * speed * speed * curvature / vehicle.wheelbase;
  return TurnWithSlip(vehicle, curvature, speed,
                      -vehicle.cg_to_rear * force / vehicle.cornering_stiffness_front,
                      -vehicle.cg_to_front() * force / vehicle.cornering_stiffness_rear);
}

TurnOperation BrushTurnOn(const VehicleParams& vehicle, const TurnMotion& motion) {
  if (!HasTyres(vehicle)) {
    return {TurnWithoutSlip(vehicle, motion.curvature, motion.speed), {}};
  }
  if (KnowsBrushAxles(vehicle)) {
    const auto [front, rear] = BrushAxles(vehicle, motion);
    return {TurnWithSlip(vehicle, motion.curvature, motion.speed, -front.slip, -rear.slip),
            {front.stiffness, rear.stiffness}};
  }
  return {SteadyTurnOn(vehicle, motion.curvature, motion.speed),
          {vehicle.cornering_stiffness_front, vehicle.cornering_stiffness_rear}};
}

double SteeringInBend(const VehicleParams& vehicle, const BendMotion& motion) {
  return BrushTurnOn(vehicle, AtConstantSpeed(motion)).turn.steering;
}

SteeringSlopes SteeringSlopesInBend(const VehicleParams& vehicle, const BendMotion& motion) {
  const TurnOperation operation = BrushTurnOn(vehicle, AtConstantSpeed(motion));
  const double cosine = std::cos(operation.turn.steering);
  const double square = cosine * cosine;
  const auto [front, rear] = operation.stiffness;
  if (!(front > 0.0 && rear > 0.0)) {
    return {.by_curvature = square * vehicle.wheelbase};
  }
  // The derivative of an axle's slip angle by its lateral force is the reciprocal of the axle's
  // lateral stiffness.
  const double on_front = vehicle.cg_to_rear / vehicle.wheelbase;
  const double softer = vehicle.mass * (on_front / front - (1.0 - on_front) / rear);
  const double understeer = softer * motion.speed * motion.speed;
  const double direction = std::copysign(1.0, motion.speed);
  return {
      .by_curvature = square * (vehicle.wheelbase + direction * understeer),
      .by_speed = square * 2.0 * direction * softer * std::abs(motion.speed) * motion.curvature};
}

double SteeringRateInBend(const VehicleParams& vehicle, const BendMotion& motion) {
  const SteeringSlopes slopes = SteeringSlopesInBend(vehicle, motion);
  return slopes.by_curvature * motion.sharpness * std::abs(motion.speed) +
         slopes.by_speed * motion.acceleration;
}

}  // namespace trackbed
