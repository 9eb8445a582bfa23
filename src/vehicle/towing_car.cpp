#include "trackbed/vehicle/towing_car.h"

#include <cmath>

#include "src/vehicle/motion.h"

namespace trackbed {

TowingCar::TowingCar(const VehicleParams& params, ReferencePoint reference,
                     const KinematicState& start, const TrailerParams& trailer, double angle)
    : params_(params),
      reference_(reference),
      car_(params, reference, start),
      trailer_(trailer),
      angle_(angle) {}

double TowingCar::RearShare(double steering) const {
  return reference_ == ReferencePoint::kRearAxle
             ? 1.0
             : std::cos(std::atan(params_.cg_to_rear * std::tan(steering) / params_.wheelbase));
}

void TowingCar::Step(const Command& command, double duration) {
  double speed = car_.state().speed;
  double steering = car_.state().steering;
  for (const MotionPiece& piece : MotionUnder(command, params_, steering, speed, duration).pieces) {
    if (piece.duration <= 0.0) {
      continue;
    }
    if (piece.steering_rate == 0.0) {
      const double moved = (speed + 0.5 * piece.acceleration * piece.duration) * piece.duration;
      angle_ = RolledHitchAngle(trailer_, angle_, CurvatureForSteering(params_, steering),
                                moved * RearShare(steering));
    } else {
      // fourth-order Runge-Kutta method; speed and steering are known functions of time
      const auto rate = [&](double time, double angle) {
        const double delta = steering + piece.steering_rate * time;
        const double v = (speed + piece.acceleration * time) * RearShare(delta);
        return RollingHitchRate(trailer_, angle, v, v * CurvatureForSteering(params_, delta));
      };
      const double half = 0.5 * piece.duration;
      const double k1 = rate(0.0, angle_);
      const double k2 = rate(half, angle_ + half * k1);
      const double k3 = rate(half, angle_ + half * k2);
      const double k4 = rate(piece.duration, angle_ + piece.duration * k3);
      angle_ += piece.duration / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    speed = piece.end_speed;
    steering = piece.end_steering;
  }
  car_.Step(command, duration);
}

TrailerState TowingCar::trailer() const {
  const VehicleState state = car_.FullState();
  return {.angle = angle_, .rate = RollingHitchRate(trailer_, angle_, state.speed, state.yaw_rate)};
}

}  // namespace trackbed
