#pragma once

#include "trackbed/planning/common/planner.h"

/// Computes the times that a car needs for driving a plan and for turning its wheels.
namespace trackbed {

/// Returns the time that the wheels need to turn from the end of a segment to the start of the next
/// one [s].
[[nodiscard]] double SteeringTime(const VehicleParams& vehicle, const Segment& before,
                                  const Segment& after);

/// Returns the driving time of a plan, with the time in which the wheels turn at rest [s].
[[nodiscard]] double DrivingTime(const Plan& plan, const VehicleParams& vehicle);

}  // namespace trackbed
