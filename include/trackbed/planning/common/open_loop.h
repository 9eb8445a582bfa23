#pragma once

#include "trackbed/path/path.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// The result of driving a plan open loop to D_end, by the kinematic car with rate-limited
/// steering.
struct OpenLoopRun {
  double goal_distance = 0.0;  ///< [m]
  double goal_heading = 0.0;   ///< heading minus that of the last leg [rad]
  double deviation_max = 0.0;  ///< largest distance from the planned path [m]
};

/// Drives `schedule` from the start of `path` over `stop_distance` [m], with the reference point on
/// the path, and compares the car with the path every 0.5 m and at its end. It changes direction
/// where the path does. Assumes that the wheels follow the schedule, which holds if the plan's
/// speeds allow it.
OpenLoopRun SimulateOpenLoop(const VehicleParams& vehicle, const Path& path,
                             const SteeringSchedule& schedule, double stop_distance,
                             ReferencePoint reference = ReferencePoint::kRearAxle);

void Visit(DiagnosticsVisitor& out, const OpenLoopRun& drive);

}  // namespace trackbed
