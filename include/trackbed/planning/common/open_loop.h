#pragma once

#include "trackbed/path/path.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// A plan driven by the kinematic car with its rate-limited steering, open loop over D_end.
struct OpenLoopRun {
  double goal_distance = 0.0;  ///< [m]
  double goal_heading = 0.0;   ///< heading minus that of the last leg [rad]
  double deviation_max = 0.0;  ///< largest distance from the planned path [m]
};

/// Drives `schedule` from the start of `path` over `stop_distance` [m], the reference point on the
/// path, and compares it with the path every 0.5 m and with its end. It changes direction where the
/// path does. The wheels follow the schedule, which holds if the plan's speeds let them.
OpenLoopRun SimulateOpenLoop(const VehicleParams& vehicle, const Path& path,
                             const SteeringSchedule& schedule, double stop_distance,
                             ReferencePoint reference = ReferencePoint::kRearAxle);

void Visit(DiagnosticsVisitor& out, const OpenLoopRun& drive);

}  // namespace trackbed
