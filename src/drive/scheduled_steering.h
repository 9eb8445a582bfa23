#pragma once

#include <algorithm>
#include <cmath>

#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// A car's motion along its plan at the start of a physics step.
struct MotionAlong {
  double distance = 0.0;      ///< on the plan's odometer [m]
  double speed = 0.0;         ///< [m/s], >= 0
  double acceleration = 0.0;  ///< [m/s^2], along the path
};

/// What to ask of the steering actuator for one physics step, so that its angle follows a schedule
/// over distance [rad]. `rate` is the actuator's [rad/s]; 0: it turns at once, and is where the
/// schedule says at the end of the step.
///
/// An actuator turns at its full rate, then waits for the next step: on a slower ramp it is early,
/// on average by half the time that it waits. That much later is the angle it is asked for. Before
/// a ramp of full rate there is nothing to be made up.
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
