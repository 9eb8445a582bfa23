#pragma once

#include <algorithm>
#include <cmath>

#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// Motion of a car along its plan at the start of a physics step.
struct MotionAlong {
  double distance = 0.0;      ///< Distance on the plan's odometer [m].
  double speed = 0.0;         ///< Speed, >= 0 [m/s].
  double acceleration = 0.0;  ///< Acceleration along the path [m/s^2].
};

/// The command for a steering actuator in one physics step, with which its angle follows a schedule
/// over distance [rad]. `rate` is the maximum rate of the actuator [rad/s]. A rate of 0 is an
/// actuator without delay, which follows the schedule at the end of each step.
///
/// An actuator turns at its full rate and then waits for the next step. On a ramp slower than its
/// rate, the actuator is ahead by half of the waiting time on average. The commanded angle is
/// therefore that of the schedule, half the waiting time earlier. On a ramp at full rate, the
/// actuator never waits.
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
