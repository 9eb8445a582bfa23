#pragma once

#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// The sharpest curvature of a segment that is linear in the distance [1/m].
double SharpestCurvature(const Segment& segment);

/// The steering over the distance that leads a kinematic car along the segments: atan(L kappa).
/// Steps of curvature are driven as the ramps of RampsOfSteps (curvature_steps.h) for a car that
/// goes at `speed` [m/s], more slowly within `caps`. Where the car stands, at changes of direction
/// and at `stops`, the step lies in the last micrometer before.
SteeringSchedule CourseSchedule(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                                double speed, const std::vector<SpeedCap>& caps = {},
                                const std::vector<double>& stops = {});

}  // namespace trackbed
