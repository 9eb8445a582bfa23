#pragma once

#include <algorithm>
#include <cmath>

#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// Motion of a car along its plan at the start of a physics step.
struct MotionAlong {
  double distance = 0.0;      ///< on the plan's odometer [m]
  double speed = 0.0;         ///< [m/s], >= 0
  double acceleration = 0.0;  ///< [m/s^2], along the path
};

/// The command for a steering actuator in one physics step, so that its angle follows a schedule
/// over distance [rad]. `rate` is the actuator's rate [rad/s]. 0: an actuator without delay, which
/// follows the schedule at the end of each step.
///
/// An actuator turns at its full rate and then waits for the next step. On a ramp slower than its
/// rate it leads by half of the waiting time on average, so the commanded angle is that of half the
/// waiting time earlier. On a ramp at full rate it never waits.
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
