#pragma once

#include <algorithm>
#include <cmath>

#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// Motion of a car along its plan at the start of a physics step.
struct MotionAlong {
  /// Position of the car on the distance axis of the steering schedule [m].
  double distance = 0.0;
  double speed = 0.0;         ///< Speed of the car along the plan [m/s], >= 0.
  double acceleration = 0.0;  ///< Acceleration of the car along the path [m/s^2].
};

/// Returns the command [rad] with which a steering actuator follows a steering schedule over
/// distance in one physics step. `rate` is the maximum rate of the actuator [rad/s]. A rate of 0
/// means no rate limit: the command is the schedule's angle at the end of the physics step.
///
/// An actuator with a rate limit turns at its full rate until it reaches the command, and then
/// waits for the next step. If the schedule is slower than the actuator's full rate, the actuator
/// is ahead of the schedule by half of the waiting time on average. To compensate for this lead,
/// the schedule is evaluated half of the waiting time before the end of the physics step. If the
/// schedule turns at the actuator's full rate, the actuator's waiting time is zero.
inline double ScheduledSteering(const SteeringSchedule& schedule, const MotionAlong& motion,
                                double timestep, double rate) {
  const auto after = [&](double time) {
    return schedule.At(motion.distance + time * (motion.speed + 0.5 * time * motion.acceleration));
  };
  if (rate == 0.0) {
    return after(timestep);
  }
  const auto wait = [&](double from) {
    const double turned = std::abs(after(from + timestep) - after(from));
    return std::max(0.0, timestep - turned / rate);
  };
  const double waits = std::min(wait(0.0), wait(timestep));
  return after(timestep - 0.5 * waits);
}

}  // namespace trackbed
