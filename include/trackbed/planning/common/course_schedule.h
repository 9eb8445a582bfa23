#pragma once

#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// The largest curvature of a segment that is linear in the distance [1/m].
double SharpestCurvature(const Segment& segment);

/// The steering over distance, atan(L kappa), with which a kinematic car follows the segments.
/// Steps of curvature become the ramps of RampsOfSteps (curvature_steps.h), for a car that drives
/// at `speed` [m/s] and slower within `caps`. The car stands at changes of direction and at
/// `stops`; there, the step lies in the last micrometer before the stop.
SteeringSchedule CourseSchedule(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                                double speed, const std::vector<SpeedCap>& caps = {},
                                const std::vector<double>& stops = {});

}  // namespace trackbed
