#pragma once

#include "trackbed/path/path.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {

/// The result of driving a plan open loop to D_end. The car is the kinematic car with rate-limited
/// steering.
struct OpenLoopRun {
  double goal_distance = 0.0;  ///< Distance of the car from the goal [m].
  double goal_heading = 0.0;   ///< Heading of the car minus that of the last leg [rad].
  double deviation_max = 0.0;  ///< Largest distance of the car from the planned path [m].
};

/// Drives `schedule` from the start of `path` over `stop_distance` [m], with the reference point on
/// the path, and compares the car with the path every 0.5 m and at the end. The car changes
/// direction at the cusps of the path. The function assumes that the wheels follow the schedule,
/// which holds for feasible speeds.
OpenLoopRun SimulateOpenLoop(const VehicleParams& vehicle, const Path& path,
                             const SteeringSchedule& schedule, double stop_distance,
                             ReferencePoint reference = ReferencePoint::kRearAxle);

void Visit(DiagnosticsVisitor& out, const OpenLoopRun& drive);

}  // namespace trackbed
