#include "src/control/steering_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "src/control/preview_distance.h"
#include "src/control/tracking.h"

namespace trackbed {
namespace {

/// Fraction of the roll-over acceleration g b/(2 h) to which a steering step is limited, with the
/// track b and the height h of the center of gravity. The body of the car leans out of the turn, so
/// in a steady turn, the inner wheels lift at a lateral acceleration below g b/(2 h). After a
/// steering step, the car's roll angle overshoots. The limit kRollShare is the fraction of g b/(2
/// h) at which wheels lift in a steady turn, divided by the roll angle's overshoot. For the four
/// cars of models/ in MuJoCo, this quotient is 0.62 (prius) to 0.67 (bmw320i); see
/// docs/algorithms/control.md. The BMW on contact tyres rolls over after steering steps to 0.75 g
/// b/(2 h).
constexpr double kRollShare = 0.65;

/// Returns the acceleration g b/(2 h) [m/s^2] at which the inner wheels of a rigid car lift, or
/// infinity if the car's dimensions are unknown.
double RigidRollOver(const VehicleParams& vehicle) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  if (vehicle.braking.axles.empty()) {
    return kUnknown;
  }
  const double height = std::abs(vehicle.braking.axles.front().transfer) * vehicle.wheelbase;
  const double track = 0.5 * (vehicle.track_front + vehicle.track_rear);
  return height > 0.0 && track > 0.0 ? kGravity * track / (2.0 * height) : kUnknown;
}

/// Returns the steering angle [rad] of a steady turn with the lateral acceleration `allowed`
/// [m/s^2], clamped to the steering limit.
double SteeringAt(const VehicleParams& vehicle, double speed, double allowed) {
  const double tightest = CurvatureForSteering(vehicle, vehicle.steering_limit);
  if (vehicle.kind != VehicleKind::kSteered || !(speed * speed * tightest > allowed)) {
    return vehicle.steering_limit;
  }
  const double steering = SteadyTurnOn(vehicle, allowed / (speed * speed), speed).steering;
  return std::clamp(std::abs(steering), 0.0, vehicle.steering_limit);
}

/// Returns the angle from the car's heading to the motion of its front axle [rad], positive to the
/// left; 0 at very low speed.
double FrontDirection(const VehicleParams& vehicle, const VehicleState& state) {
  const double across = state.lateral_speed + vehicle.cg_to_front() * state.yaw_rate;
  return std::abs(state.speed) < kCrawl ? 0.0 : std::atan(across / state.speed);
}

/// Returns the lateral acceleration [m/s^2] at which the tyres slide, or infinity if the friction
/// is unknown.
double SlidingAcceleration(const VehicleParams& vehicle) {
  return vehicle.friction_lateral > 0.0 ? vehicle.friction_lateral * kGravity
                                        : std::numeric_limits<double>::infinity();
}

/// Returns the largest lateral acceleration [m/s^2] after a step of the steering angle that does
/// not lift the inner wheels, or infinity if the car's dimensions are unknown. The step starts in a
/// steady turn with the lateral acceleration `held` [m/s^2].
double RollOverInAStep(const VehicleParams& vehicle, double held) {
  return kRollShare * RigidRollOver(vehicle) + (1.0 - kRollShare) * held;
}

/// Slip angle of the front tyres up to which a car may steer in a turn that it holds.
struct FrontSlip {
  double slip = 0.0;          // [rad]
  double acceleration = 0.0;  // Lateral acceleration at which the whole slip is allowed [m/s^2].
};

/// Returns the slip angle at which the front tyres slide, if they slide before the rear tyres and
/// before a step lifts the inner wheels. Otherwise, returns the slip angle of the front tyres in
/// the steady turn with the largest lateral acceleration. Returns none if the car does not drive
/// forward, or if its tyres are unknown.
std::optional<FrontSlip> LargestSlipOfFront(const VehicleParams& vehicle, double speed,
                                            double held) {
  const double sliding = SlidingAcceleration(vehicle);
  const double lifting = RollOverInAStep(vehicle, held);
  const std::vector<AxleGrip>& axles = vehicle.braking.axles;
  if (!(speed > 0.0) || !HasTyres(vehicle) || axles.size() != 2 || !std::isfinite(sliding)) {
    return std::nullopt;
  }
  // In the brush model of the tyres, an axle slides at the normalized slip q = 1 (brush_axle.h).
  const double force = 3.0 * vehicle.mass * sliding;
  const double front = force * axles[0].weight / vehicle.cornering_stiffness_front;
  const double rear = force * axles[1].weight / vehicle.cornering_stiffness_rear;
  if (sliding <= lifting && front > rear) {
    return FrontSlip{front, sliding};
  }
  const double most = std::min(sliding, lifting);
  const double curvature = most / (speed * speed);
  const SteadyTurn turn = BrushTurnOn(vehicle, {.curvature = curvature, .speed = speed}).turn;
  // In the turn, tan(delta) = L kappa + s_f - s_r, and the heading error is s_r.
  const double slip = std::tan(turn.steering) - vehicle.wheelbase * curvature + turn.heading_error;
  return FrontSlip{slip, most};
}

/// Returns the largest allowed steering angle [rad] to the side of the turn. The argument `rolling`
/// is the direction in which the front axle moves [rad], positive to the side of the turn.
double AllowedToOneSide(const VehicleParams& vehicle, double speed, double held, double rolling) {
  const double step = SteeringInAStep(vehicle, speed, held);
  double most = step;
  if (const auto front = LargestSlipOfFront(vehicle, speed, held)) {
    const double share = std::min(1.0, held / front->acceleration);
    most = std::lerp(step, std::max(step, rolling + front->slip), share);
  }
  return std::min(std::max(most, rolling), vehicle.steering_limit);
}

}  // namespace

double LateralGrip(const VehicleParams& vehicle) {
  return std::min(SlidingAcceleration(vehicle), RigidRollOver(vehicle));
}

double SteeringAtGrip(const VehicleParams& vehicle, double speed) {
  return SteeringAt(vehicle, speed, LateralGrip(vehicle));
}

double SteeringInAStep(const VehicleParams& vehicle, double speed, double held) {
  const double allowed = std::min(LateralGrip(vehicle), RollOverInAStep(vehicle, held));
  const double linear = SteeringAt(vehicle, speed, allowed);
  if (linear >= vehicle.steering_limit) {
    return linear;
  }
  const double curvature = allowed / (speed * speed);
  const double brush = BrushTurnOn(vehicle, {.curvature = curvature, .speed = speed}).turn.steering;
  return std::min(std::max({linear, std::abs(brush), SteeringForCurvature(vehicle, curvature)}),
                  vehicle.steering_limit);
}

double TurnRoundLimit(const VehicleParams& vehicle, double speed) {
  return SteeringAt(vehicle, speed, kReturnGripShare * LateralGrip(vehicle));
}

SteeringRange AllowedSteering(const VehicleParams& vehicle, const VehicleState& state,
                              double curvature) {
  const double present = state.speed * state.yaw_rate;
  const double planned = state.speed * state.speed * curvature;
  const double left = std::max(std::min(present, planned), 0.0);
  const double right = std::max(std::min(-present, -planned), 0.0);
  const double rolling = FrontDirection(vehicle, state);
  return {.lowest = -AllowedToOneSide(vehicle, state.speed, right, -rolling),
          .highest = AllowedToOneSide(vehicle, state.speed, left, rolling)};
}

double SteeringAhead(const ControlInput& input, double distance) {
  const SpeedProfile& planned = input.reference.speed;
  const double present = std::abs(input.state.speed);
  const auto speed_at = [&](double station) {
    const double excess = planned.knots().empty() ? 0.0 : present - planned.SpeedAt(input.station);
    const double speed = planned.knots().empty() ? present : planned.SpeedAt(station);
    return std::max(speed + excess, 0.0);
  };
  const double last = input.station + distance;
  double most = 0.0;
  double held = 0.0;   // Lateral acceleration of the turn with the angle `most`.
  double speed = 0.0;  // Speed of the turn with the angle `most`.
  double begin = 0.0;
  for (const Segment& segment : input.reference.path.segments()) {
    const double end = begin + segment.length;
    if (begin > last) {
      break;
    }
    // The curvature is linear in the station, so its largest value is at an end.
    for (const double s : {std::max(begin, input.station), std::min(end, last)}) {
      const double curvature = end < input.station ? 0.0 : std::abs(segment.CurvatureAt(s - begin));
      if (curvature > 0.0) {
        const double v = speed_at(s);
        const double steering = std::max(SteeringForCurvature(input.vehicle, curvature),
                                         SteadyTurnOn(input.vehicle, curvature, v).steering);
        if (steering > most) {
          most = steering;
          held = v * v * curvature;
          speed = v;
        }
      }
    }
    begin = end;
  }
  return most > 0.0 ? std::min(most, SteeringInAStep(input.vehicle, speed, held)) : 0.0;
}

}  // namespace trackbed
