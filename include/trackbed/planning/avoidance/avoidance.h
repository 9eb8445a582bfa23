#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/optimize/search.h"
#include "trackbed/planning/avoidance/avoidance_options.h"
#include "trackbed/planning/avoidance/turn_maneuver.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan_diagnostics.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/sampling/rrt_star.h"
#include "trackbed/vehicle/params.h"

/// Local planners, which reroute a plan around obstacles in its way. The planner `bezier` chooses
/// the passing side by RRT*, passes on a Bezier curve of degree 7, and moves the control points by
/// a search until the car can drive the curve safely. The planner `listing` is the original method
/// as printed (Skackauskas, dissertation, listing F.2). The curve of `listing` is not checked, and
/// serves for comparison only.
///
/// Symbols: SD safe distance, from the car's footprint to an obstacle [m]; t_d system delay [s]; S
/// = r + v t_d [m], where r is the radius of a turn. The car leaves its path at most the distance S
/// before the turn, and returns to the path at most the distance S after the turn.
namespace trackbed {

/// The safety check of the original listing (condition Salyga_2), for comparison. The check tests
/// the distance of a single point of the path from the obstacle's corners. The point lies two
/// meters before the obstacle along the path.
struct OnePointCheck {
  double distance = 0.0;  ///< Distance to the nearest corner [m].
  bool passed = false;    ///< Whether the distance is at least SD plus half the car's width.
};
void Visit(DiagnosticsVisitor& out, const OnePointCheck& check);

/// Diagnostics of the local planner `bezier` for a replaced stretch, stored in
/// AvoidedStretch::method.
struct BezierAvoidanceDiagnostics {
  int curves_tried = 0;
  RrtStarStatus tree_status = RrtStarStatus::kNotReached;
  int tree_iterations = 0;
  std::size_t tree_nodes = 0;
  double tree_cost = 0.0;       ///< Path cost, if the tree found a path [m].
  std::vector<Vec2> tree_path;  ///< Path points, if the tree found a path [m].
  std::string search_method;
  int search_evaluations = 0;
  double search_objective = 0.0;
  OnePointCheck one_point_check;
};
void Visit(DiagnosticsVisitor& out, const BezierAvoidanceDiagnostics& own);

/// Diagnostics of the local planner `listing` for a replaced stretch, stored in
/// AvoidedStretch::method.
struct ListingAvoidanceDiagnostics {
  /// Number of the sixth of the turn's arc at which the method assumes the obstacle.
  int obstacle_sixth = 0;
  std::size_t tree_nodes = 0;
  double goal_distance = 0.0;  ///< Distance of the goal from the tree's nearest node [m].
  double final_y = 0.0;        ///< Coordinate y of the tree's final node [m], see turn_maneuver.h.
  OnePointCheck one_point_check;
};
void Visit(DiagnosticsVisitor& out, const ListingAvoidanceDiagnostics& own);

struct AvoiderEntry {
  const char* name;
  const char* summary;
  AvoiderOptions defaults;
  /// Whether the planned curves keep the safe distance SD and the steering limits.
  bool keeps_clear = false;
};

/// Returns all local planners.
const std::vector<AvoiderEntry>& LocalPlanners();

/// The input of a local planner.
struct AvoidanceRequest {
  VehicleParams vehicle;
  Plan plan;                           ///< The current plan.
  SpeedLimits speed;                   ///< Limits of the mission.
  std::vector<OrientedBox> obstacles;  ///< Obstacles known so far.
  double station = 0.0;                ///< The car cannot leave the plan before this station [m].
  double station_speed = 0.0;          ///< Speed of the car at `station` [m/s].
  /// The actual state of the car at `station`. If the state is given, the new plan and its stations
  /// start at `station`. If the obstacle is near, the new plan starts at the actual pose of the
  /// car, else on the old plan.
  struct Car {
    Pose2 pose;             ///< Pose of the rear axle.
    double steering = 0.0;  ///< Actual steering angle of the bicycle model [rad].
  };
  std::optional<Car> car;
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< Road conditions that limit the new plan.
};

/// Returns whether a car on the path beyond `station` comes closer than `distance` [m] to an
/// obstacle.
bool IsInTheWay(const VehicleParams& vehicle, const Path& path, double station,
                const OrientedBox& obstacle, double distance);

/// Reroutes the plan around the obstacles. PlanDiagnostics::avoided has an entry for each replaced
/// stretch. A plan that is already clear is returned unchanged. If an obstacle cannot be passed,
/// the plan ends before the obstacle and states the reason (Plan::blocked). The planner `bezier`
/// tries speeds down to `min_speed`.
///
/// Guarantees: position and heading are continuous. If the state of the car is not given, the plan
/// is unchanged before the new stretch. On a stretch of `bezier`, the footprint keeps at least the
/// distance SD from every known obstacle (checked every 0.05 m). The steering angle on the stretch
/// is within the car's limit, and the steering rate at the planned speed is within the given
/// fraction of the car's limit. The curvature is continuous at both ends of the new stretch; at the
/// start, the curvature matches the plan or the car's actual steering. The planner `listing` has no
/// such guarantees. For `listing`, a note of the plan states the clearance of the curve and by how
/// much the curve exceeds the steering's limits. Only obstacles closer to the plan than SD are
/// considered, and are assumed to stand still. MakeFeasible slows an infeasible new plan down or
/// rejects it; with `listing`, MakeFeasible allows the plan unchanged. If the new plan is rejected,
/// the result is a plan that stops before the first obstacle. If the car is already driving, this
/// plan may brake harder than the grip of the road allows; a note of the plan then says so. Errors:
/// InternalError for options out of range. Cost of `bezier`: 0.1 to 0.3 s per stretch, some seconds
/// if there is no solution. Cost of `listing`: a millisecond.
FeasiblePlan PlanAround(const AvoidanceRequest& request, const AvoiderOptions& options);

}  // namespace trackbed
