#pragma once

#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// Returns the curvature of largest magnitude on a segment whose curvature is linear in the
/// distance [1/m].
double SharpestCurvature(const Segment& segment);

/// Computes the steering schedule with which a kinematic car follows the segments: the steering
/// angle atan(L kappa) as a function of the driven distance. At a step of curvature, the steering
/// angle follows a ramp computed by RampsOfSteps (curvature_steps.h), for a car that drives at
/// `speed` [m/s], or more slowly within `caps`. The car stops at changes of direction and at the
/// stations `stops`. Where the car stops, the scheduled steering angle changes within the last
/// micrometer before the stop.
SteeringSchedule CourseSchedule(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                                double speed, const std::vector<SpeedCap>& caps = {},
                                const std::vector<double>& stops = {});

}  // namespace trackbed
