#pragma once

#include "trackbed/path/path.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// The result of simulating a plan open loop up to the planned stop. The simulated car is
/// kinematic, with rate-limited steering.
struct OpenLoopRun {
  double goal_distance = 0.0;  ///< Distance of the car from the goal [m].
  double goal_heading = 0.0;   ///< Heading of the car minus the heading of the last leg [rad].
  double deviation_max = 0.0;  ///< Largest distance of the car from the planned path [m].
};

/// Simulates a kinematic car that steers by `schedule` from the start of `path` over
/// `stop_distance` [m]. Compares the reference point of the car with the path every 0.5 m and at
/// the end. The reference point starts on the path. The car changes direction at the cusps of the
/// path. The function assumes that the wheels follow the schedule exactly, which is true at
/// feasible speeds.
OpenLoopRun SimulateOpenLoop(const VehicleParams& vehicle, const Path& path,
                             const SteeringSchedule& schedule, double stop_distance,
                             ReferencePoint reference = ReferencePoint::kRearAxle);

void Visit(DiagnosticsVisitor& out, const OpenLoopRun& drive);

}  // namespace trackbed
