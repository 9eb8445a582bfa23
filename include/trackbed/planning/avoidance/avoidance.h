#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/planning/avoidance/avoidance_diagnostics.h"
#include "trackbed/planning/avoidance/avoidance_options.h"
#include "trackbed/planning/avoidance/turn_maneuver.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/vehicle/params.h"

/// Local planners, which reroute an existing plan around the obstacles that are in its way. The
/// planner `bezier` chooses the passing side by RRT* and passes the obstacle on a Bezier curve of
/// degree 7. A search moves the control points of the Bezier curve until the car can drive the
/// curve safely. The planner `listing` reproduces the original method exactly as printed
/// (Skackauskas, dissertation, listing F.2). The planner `listing` does not check its curve, and
/// serves for comparison only.
///
/// Symbols: SD is the safe distance from the car's footprint to an obstacle [m]; t_d is the system
/// delay [s]; S = r + v t_d [m], where r is the radius of a turn and v the speed. To pass an
/// obstacle in a turn, the car leaves its path at most the distance S = r + v t_d before the turn
/// of radius r. The car returns to the path at most the distance S = r + v t_d after the turn of
/// radius r.
namespace trackbed {

struct AvoiderEntry {
  const char* name;
  const char* summary;
  AvoiderOptions defaults;
  /// Whether the curves of this local planner keep the safe distance SD and the car's steering
  /// limits.
  bool keeps_clear = false;
};

/// Returns all local planners, which reroute plans around obstacles.
const std::vector<AvoiderEntry>& LocalPlanners();

/// The input of a local planner.
struct AvoidanceRequest {
  VehicleParams vehicle;
  Plan plan;                           ///< The current plan.
  SpeedLimits speed;                   ///< The mission's limits on speed and acceleration.
  std::vector<OrientedBox> obstacles;  ///< Obstacles that the car knows so far.
  double station = 0.0;                ///< First station at which the car can leave the plan [m].
  double station_speed = 0.0;          ///< Speed of the car at `station` [m/s].
  /// The actual state of the car at `station`. If the car's state is given, the new plan begins at
  /// `station`, and the stations of the new plan count from `station`. The new plan begins at the
  /// actual pose of the car if the obstacle is near, else on the old plan.
  struct Car {
    Pose2 pose;             ///< Pose of the car's rear axle.
    double steering = 0.0;  ///< Actual steering angle of the bicycle model [rad].
  };
  std::optional<Car> car;
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< Conditions of the road that limit the new plan.
};

/// Returns whether a car on the path beyond `station` comes closer than `distance` [m] to an
/// obstacle.
bool IsInTheWay(const VehicleParams& vehicle, const Path& path, double station,
                const OrientedBox& obstacle, double distance);

/// Reroutes the plan of the request around the known obstacles. PlanDiagnostics::avoided receives
/// an entry for each replaced stretch of the path. A plan that is already clear of obstacles is
/// returned unchanged. If an obstacle cannot be passed, the plan ends before the obstacle and
/// states the reason (Plan::blocked). The planner `bezier` tries lower and lower passing speeds,
/// down to `min_speed`.
///
/// Guarantees: position and heading are continuous along the new plan. If the state of the car is
/// not given, the plan is unchanged before the new stretch. On a stretch that `bezier` has
/// replaced, the car's footprint keeps at least the safe distance SD from every known obstacle
/// (checked every 0.05 m). On a stretch that `bezier` has replaced, the steering angle is within
/// the car's limit. On a stretch that `bezier` has replaced, the steering rate at the planned speed
/// is within the fraction `max_steering_rate_fraction` of the car's limit. The curvature is
/// continuous at both ends of the new stretch; at its start, the curvature matches the old plan or
/// the car's actual steering. The planner `listing` guarantees neither clearance nor steerability.
/// With `listing`, a note of the plan states the clearance of the curve, and by how much the curve
/// exceeds the limits of the steering. The local planners consider only obstacles that are closer
/// to the plan than the safe distance SD, and assume that these obstacles stand still. MakeFeasible
/// slows down or rejects a new plan that exceeds the car's limits; plans of `listing` stay
/// unchanged. If the new plan is rejected, the result is a plan that stops before the first
/// obstacle. If the car is already driving, the stopping plan may brake harder than the grip of the
/// road allows, with a note in the plan. Throws InternalError if an option is out of range.
/// Computing time of `bezier`: 0.1 to 0.3 s per replaced stretch, some seconds if there is no
/// solution. Computing time of `listing`: a millisecond.
FeasiblePlan PlanAround(const AvoidanceRequest& request, const AvoiderOptions& options);

}  // namespace trackbed
