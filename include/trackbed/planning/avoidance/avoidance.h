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
#include "trackbed/planning/common/plan_diagnostics.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/sampling/rrt_star.h"
#include "trackbed/vehicle/params.h"

/// The local planners: they lead a plan around obstacles that stand in its way. In `bezier`, RRT*
/// finds on which side to pass, a Bezier curve of degree 7 leads past, and a search moves its
/// control points until it can be driven safely. `listing` is what that is based on
/// (Skackauskas, dissertation, listing F.2), as printed: a curve that nothing checks, to compare
/// with.
///
/// Symbols: SD safe distance, from the car's footprint to an obstacle [m]; t_d system delay [s];
/// S = r + v t_d the distance before and after a turn of radius r within which the car leaves its
/// path and is back on it [m].
namespace trackbed {

/// The listing's check, for comparison (Salyga_2): a single point of the path, two meters before it
/// is beside the obstacle, against the obstacle's corners.
struct OnePointCheck {
  double distance = 0.0;  ///< to the nearest corner [m]
  bool passed = false;    ///< at least SD and half the car's width away
};
void Visit(DiagnosticsVisitor& out, const OnePointCheck& check);

/// What `bezier` says of a stretch: AvoidedStretch::method.
struct BezierAvoidanceDiagnostics {
  int curves_tried = 0;
  RrtStarStatus tree_status = RrtStarStatus::kNotReached;
  int tree_iterations = 0;
  std::size_t tree_nodes = 0;
  double tree_cost = 0.0;       ///< of a tree that found a path [m]
  std::vector<Vec2> tree_path;  ///< likewise [m]
  std::string search_method;
  int search_evaluations = 0;
  double search_objective = 0.0;
  OnePointCheck one_point_check;
};
void Visit(DiagnosticsVisitor& out, const BezierAvoidanceDiagnostics& own);

/// What `listing` says of one.
struct ListingAvoidanceDiagnostics {
  int obstacle_sixth = 0;  ///< of the arc, at which the obstacle is taken to stand
  std::size_t tree_nodes = 0;
  double goal_distance = 0.0;  ///< from the tree to its goal [m]
  double final_y = 0.0;        ///< of the tree's path, see turn_maneuver.h [m]
  OnePointCheck one_point_check;
};
void Visit(DiagnosticsVisitor& out, const ListingAvoidanceDiagnostics& own);

struct AvoiderEntry {
  const char* name;
  const char* summary;
  AvoiderOptions defaults;
  bool keeps_clear = false;  ///< its curves keep SD and the limits of the steering
};

/// Every local planner there is.
const std::vector<AvoiderEntry>& LocalPlanners();

/// What the local planner is told.
struct AvoidanceRequest {
  VehicleParams vehicle;
  Plan plan;                           ///< that is being driven
  SpeedLimits speed;                   ///< of the mission
  std::vector<OrientedBox> obstacles;  ///< known so far
  double station = 0.0;                ///< the plan cannot be left before here [m]
  double station_speed = 0.0;          ///< of the car there [m/s]
  /// The car as it is at `station`. The new plan then starts there, and its stations with it: from
  /// the car itself if the obstacle is near, else along the old plan.
  struct Car {
    Pose2 pose;             ///< rear axle
    double steering = 0.0;  ///< actual bicycle angle [rad]
  };
  std::optional<Car> car;
  std::uint64_t seed = 0;
};

/// Whether the rest of a plan, from `station` on, comes closer than `distance` to an obstacle.
bool IsInTheWay(const VehicleParams& vehicle, const Path& path, double station,
                const OrientedBox& obstacle, double distance);

/// The plan that avoids the obstacles. PlanDiagnostics::avoided has an
/// entry for each stretch that was replaced; a plan that nothing stands in the way of comes back as
/// it was. Where an obstacle cannot be passed, by `bezier` not even at `min_speed`, the plan ends
/// before it and says why (Plan::blocked).
///
/// Guarantees: position and heading are continuous. Without a car, the plan up to where it is left
/// is unchanged. Every stretch that `bezier` replaced keeps the footprint at least SD from every
/// known obstacle (sampled every 0.05 m), the steering within the car's limit, its rate at the
/// planned speed within the given share, and has the curvature of the rest at its ends: at its
/// start that of the plan, or of the car's actual steering. `listing` guarantees none of this; a
/// note of the plan says how near its curve comes and what it asks beyond the steering's limits.
/// Does not look at obstacles beyond SD from the plan, nor move them. Errors: InternalError for
/// options out of range. Cost of `bezier`: 0.1 to 0.3 s a stretch, some seconds where nothing can
/// be found; of `listing` a millisecond.
Plan PlanAround(const AvoidanceRequest& request, const AvoiderOptions& options);

}  // namespace trackbed
