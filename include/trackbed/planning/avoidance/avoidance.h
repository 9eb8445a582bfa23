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

/// Local planners, which reroute a plan around obstacles in its way. `bezier` chooses the passing
/// side by RRT*, passes on a Bezier curve of degree 7, and moves its control points by a search
/// until the curve can be driven safely. `listing` is the method that it is based on (Skackauskas,
/// dissertation, listing F.2), as printed: an unchecked curve, for comparison.
///
/// Symbols: SD safe distance, from the car's footprint to an obstacle [m]; t_d system delay [s]; S
/// = r + v t_d [m], where r is the radius of a turn: the car leaves its path at most S before the
/// turn and is back on it at most S after.
namespace trackbed {

/// The listing's check (Salyga_2), for comparison: the distance of a single point of the path, two
/// meters before it is beside the obstacle, from the obstacle's corners.
struct OnePointCheck {
  double distance = 0.0;  ///< to the nearest corner [m]
  bool passed = false;    ///< at least SD and half the car's width away
};
void Visit(DiagnosticsVisitor& out, const OnePointCheck& check);

/// Diagnostics of `bezier` for a stretch: AvoidedStretch::method.
struct BezierAvoidanceDiagnostics {
  int curves_tried = 0;
  RrtStarStatus tree_status = RrtStarStatus::kNotReached;
  int tree_iterations = 0;
  std::size_t tree_nodes = 0;
  double tree_cost = 0.0;       ///< path cost, if the tree found a path [m]
  std::vector<Vec2> tree_path;  ///< path points, if the tree found a path [m]
  std::string search_method;
  int search_evaluations = 0;
  double search_objective = 0.0;
  OnePointCheck one_point_check;
};
void Visit(DiagnosticsVisitor& out, const BezierAvoidanceDiagnostics& own);

/// Diagnostics of `listing` for a stretch.
struct ListingAvoidanceDiagnostics {
  int obstacle_sixth = 0;  ///< sixth of the arc at which the obstacle is assumed
  std::size_t tree_nodes = 0;
  double goal_distance = 0.0;  ///< from the tree's nearest node [m]
  double final_y = 0.0;        ///< of the tree's path, see turn_maneuver.h [m]
  OnePointCheck one_point_check;
};
void Visit(DiagnosticsVisitor& out, const ListingAvoidanceDiagnostics& own);

struct AvoiderEntry {
  const char* name;
  const char* summary;
  AvoiderOptions defaults;
  bool keeps_clear = false;  ///< its curves keep SD and the steering limits
};

/// All local planners.
const std::vector<AvoiderEntry>& LocalPlanners();

/// The input of a local planner.
struct AvoidanceRequest {
  VehicleParams vehicle;
  Plan plan;                           ///< the current plan
  SpeedLimits speed;                   ///< of the mission
  std::vector<OrientedBox> obstacles;  ///< known so far
  double station = 0.0;                ///< the car cannot leave the plan before this station [m]
  double station_speed = 0.0;          ///< of the car there [m/s]
  /// The car's state at `station`. If given, the new plan and its stations start there: at the car
  /// itself if the obstacle is near, else along the old plan.
  struct Car {
    Pose2 pose;             ///< rear axle
    double steering = 0.0;  ///< actual bicycle angle [rad]
  };
  std::optional<Car> car;
  std::uint64_t seed = 0;
  RoadConditions road{};  ///< that the new plan is held to
};

/// Whether the rest of a plan, from `station` on, comes closer than `distance` [m] to an obstacle.
bool IsInTheWay(const VehicleParams& vehicle, const Path& path, double station,
                const OrientedBox& obstacle, double distance);

/// Reroutes the plan around the obstacles. PlanDiagnostics::avoided has an entry for each replaced
/// stretch; a plan that is already clear is returned unchanged. If an obstacle cannot be passed, by
/// `bezier` not even at `min_speed`, the plan ends before it and states the reason (Plan::blocked).
///
/// Guarantees: position and heading are continuous. Without a car, the plan is unchanged up to
/// where the new stretch begins. Every stretch replaced by `bezier` keeps the footprint at least SD
/// from every known obstacle (sampled every 0.05 m), the steering within the car's limit, its rate
/// at the planned speed within the given fraction, and a continuous curvature at its ends (at the
/// start, that of the plan or of the car's actual steering). `listing` guarantees none of this; a
/// note of the plan states the clearance of its curve and by how much it exceeds the steering's
/// limits. Considers only obstacles within SD of the plan, and assumes that they stand still.
/// The new plan passes MakeFeasible, which slows it down or refuses it, that of `listing` with
/// InfeasiblePolicy::kAllow. Refused, it ends before the first obstacle; of a car that is on the
/// way, that stop is driven even if the road holds less, with a note.
/// Errors: InternalError for options out of range. Cost of `bezier`: 0.1 to 0.3 s per stretch, some
/// seconds if there is no solution; of `listing`: a millisecond.
FeasiblePlan PlanAround(const AvoidanceRequest& request, const AvoiderOptions& options);

}  // namespace trackbed
