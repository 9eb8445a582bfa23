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

/// Returns the steering angle [rad] of the steady turn in which the car uses the fraction `share`
/// of its lateral grip, but at most the steering limit.
double SteeringAtShare(const VehicleParams& vehicle, double speed, double share) {
  const double tightest = CurvatureForSteering(vehicle, vehicle.steering_limit);
  const double allowed = share * LateralGrip(vehicle);
  if (vehicle.kind != VehicleKind::kSteered || !(speed * speed * tightest > allowed)) {
    return vehicle.steering_limit;
  }
  const double steering = SteadyTurnOn(vehicle, allowed / (speed * speed), speed).steering;
  return std::clamp(std::abs(steering), 0.0, vehicle.steering_limit);
}

}  // namespace

double LateralGrip(const VehicleParams& vehicle) {
  double grip = std::numeric_limits<double>::infinity();
  if (vehicle.friction_lateral > 0.0) {
    grip = vehicle.friction_lateral * kGravity;
  }
  if (!vehicle.braking.axles.empty()) {
    const double height = std::abs(vehicle.braking.axles.front().transfer) * vehicle.wheelbase;
    const double track = 0.5 * (vehicle.track_front + vehicle.track_rear);
    if (height > 0.0 && track > 0.0) {
      grip = std::min(grip, kGravity * track / (2.0 * height));
    }
  }
  return grip;
}

double SteeringAtGrip(const VehicleParams& vehicle, double speed) {
  return SteeringAtShare(vehicle, speed, 1.0);
}

double TurnRoundLimit(const VehicleParams& vehicle, double speed) {
  return SteeringAtShare(vehicle, speed, kReturnGripShare);
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
