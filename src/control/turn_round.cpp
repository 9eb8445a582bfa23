#include "src/control/turn_round.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/control/preview_distance.h"
#include "src/control/tracking.h"
#include "trackbed/control/preview.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

/// Fraction of g b/(2 h) to which a step of the steering angle is limited. The body of the car
/// leans out of the turn, so the inner wheels lift at 0.83 of g b/(2 h) in a steady turn (Prius in
/// MuJoCo), and the roll angle overshoots after a step, by a factor of 1.25 at a damping ratio of
/// 0.4. In MuJoCo, the BMW 320i on contact tyres rolls over after steps to 0.75 of g b/(2 h).
constexpr double kRollShare = 0.65;

/// Returns the acceleration g b/(2 h) [m/s^2] at which the inner wheels of a rigid car lift.
/// Infinite if unknown.
double RigidRollOver(const VehicleParams& vehicle) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  if (vehicle.braking.axles.empty()) {
    return kUnknown;
  }
  const double height = std::abs(vehicle.braking.axles.front().transfer) * vehicle.wheelbase;
  const double track = 0.5 * (vehicle.track_front + vehicle.track_rear);
  return height > 0.0 && track > 0.0 ? kGravity * track / (2.0 * height) : kUnknown;
}

/// Returns the steering angle [rad] of the steady turn with the lateral acceleration `allowed`
/// [m/s^2], but at most the steering limit.
double SteeringAt(const VehicleParams& vehicle, double speed, double allowed) {
  const double tightest = CurvatureForSteering(vehicle, vehicle.steering_limit);
  if (vehicle.kind != VehicleKind::kSteered || !(speed * speed * tightest > allowed)) {
    return vehicle.steering_limit;
  }
  const double steering = SteadyTurnOn(vehicle, allowed / (speed * speed), speed).steering;
  return std::clamp(std::abs(steering), 0.0, vehicle.steering_limit);
}

}  // namespace

double LateralGrip(const VehicleParams& vehicle) {
  const double sliding = vehicle.friction_lateral > 0.0 ? vehicle.friction_lateral * kGravity
                                                        : std::numeric_limits<double>::infinity();
  return std::min(sliding, RigidRollOver(vehicle));
}

double SteeringAtGrip(const VehicleParams& vehicle, double speed) {
  return SteeringAt(vehicle, speed, LateralGrip(vehicle));
}

double SteeringInAStep(const VehicleParams& vehicle, double speed) {
  return SteeringAt(vehicle, speed,
                    std::min(LateralGrip(vehicle), kRollShare * RigidRollOver(vehicle)));
}

double TurnRoundLimit(const VehicleParams& vehicle, double speed) {
  return SteeringAt(vehicle, speed, kReturnGripShare * LateralGrip(vehicle));
}

std::optional<double> TurnRound::Steer(const ControlInput& input, double u) {
  const Path& path = input.reference.path;
  // The angle from the direction of the path to P is u + psi.
  if (std::cos(u) >= 0.0 ||
      std::cos(u + AngleDifference(input.state.pose.yaw, path.At(input.station).pose.yaw)) < 0.0) {
    side_ = 0.0;
    return std::nullopt;
  }
  if (side_ == 0.0) {
    side_ = std::copysign(1.0, u);
  }
  const int direction = path.BendAt(input.station).direction;
  return direction * side_ * TurnRoundLimit(input.vehicle, input.state.speed);
}

std::optional<double> TurnRound::Steer(const ControlInput& input) {
  const double heading_error =
      AngleDifference(input.state.pose.yaw, input.reference.path.At(input.station).pose.yaw);
  // A law without a preview point needs no turn round if its heading error is below 90
  // degrees.
  if (std::cos(heading_error) > 0.0) {
    side_ = 0.0;
    return std::nullopt;
  }
  return Steer(input, PreviewAngle(input.reference.path, input.state.pose, input.station,
                                   std::max(PreviewDistance(input), ReturnDistance(input))));
}

}  // namespace trackbed
