#pragma once

#include "trackbed/path/path.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// The result of simulating an open-loop run of a plan up to the planned stop. The simulated car is
/// kinematic, and its steering rate is limited.
struct OpenLoopRun {
  double goal_distance = 0.0;  ///< Distance of the car from the goal at the end of the run [m].
  /// Heading of the car at the end of the run, minus the heading at the path's end [rad].
  double goal_heading = 0.0;
  /// Largest distance of the car from the planned path during the run [m].
  double deviation_max = 0.0;
};

/// Simulates a kinematic car that steers by `schedule` and drives `stop_distance` [m] from the
/// start of `path`. Measures the distance between the car's reference point and the path every 0.5
/// m and at the end of the run. The reference point of the car starts on the path. The car changes
/// direction at the cusps of the path. The simulated wheels follow the steering schedule exactly,
/// as real wheels do at feasible speeds.
OpenLoopRun SimulateOpenLoop(const VehicleParams& vehicle, const Path& path,
                             const SteeringSchedule& schedule, double stop_distance,
                             ReferencePoint reference = ReferencePoint::kRearAxle);

void Visit(DiagnosticsVisitor& out, const OpenLoopRun& drive);

}  // namespace trackbed
