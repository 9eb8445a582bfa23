#include "src/vehicle/motion.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"
#include "trackbed/vehicle/steering_actuator.h"

namespace trackbed {

Motion MotionUnder(const Command& command, const VehicleParams& params, double steering,
                   double speed, double duration) {
  TRACKBED_REQUIRE(
      std::isfinite(command.steering) && std::isfinite(command.acceleration) && duration >= 0.0 &&
          std::isfinite(duration),
      "Step: steering {}, acceleration {}, duration {} s; must be finite, the duration "
      "at least 0",
      command.steering, command.acceleration, duration);
  const SteeringMove move =
      MoveSteering({params.steering_limit, params.steering_rate}, steering, command.steering);
  // A braking car stops when its speed reaches zero. A car at rest accelerates only in the
  // direction of its gear.
  const bool slowing = speed * command.acceleration < 0.0;
  const bool may_leave = command.acceleration * command.gear > 0.0;
  const bool held = speed == 0.0 && !may_leave;
  const double rest_time = held ? 0.0 : slowing ? -speed / command.acceleration : duration;
  const bool rests = held || (slowing && !may_leave && rest_time <= duration);

  Motion motion;
  double done = 0.0;
  const std::array<double, 3> corners{std::min(std::min(move.ramp_time, rest_time), duration),
                                      std::min(std::max(move.ramp_time, rest_time), duration),
                                      duration};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] <= done) {
      continue;
    }
    MotionPiece& piece = motion.pieces[i];
    piece.duration = corners[i] - done;
    piece.steering_rate = done < move.ramp_time ? move.rate : 0.0;
    piece.acceleration = done < rest_time || !rests ? command.acceleration : 0.0;
    done = corners[i];
    speed += piece.acceleration * piece.duration;
    if (done == rest_time && slowing) {
      speed = 0.0;
    }
    piece.end_speed = speed;
    piece.end_steering = move.At(done);
  }
  // Steering rate and acceleration are constant within a motion piece and jump between pieces. At
  // the time at which one motion piece ends, its steering rate and acceleration still apply. Times
  // that differ by less than a nanosecond count as equal, because of rounding errors.
  constexpr double kNanosecond = 1e-9;
  motion.steering_rate = duration <= move.ramp_time + kNanosecond ? move.rate : 0.0;
  motion.acceleration = rests && rest_time < duration - kNanosecond ? 0.0 : command.acceleration;
  return motion;
}

}  // namespace trackbed
