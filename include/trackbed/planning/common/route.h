#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/lead_in.h"
#include "trackbed/planning/common/plan.h"

/// Functions shared by the planners that plan from stop to stop along a route and avoid obstacles.
namespace trackbed {

/// Returns the poses at the stops of a route: the car's start pose, then the pose at every waypoint
/// except the first. If the request has no headings, the heading at the goal is the direction of
/// the last leg. Without requested headings, the heading at an intermediate waypoint is the
/// direction of the circle through this waypoint, the preceding stop and the next stop. On the
/// circle through three stops, the heading changes more along the longer leg.
std::vector<Pose2> PlannedStops(const PlanRequest& request);

namespace route {

/// Makes a rejected plan with the given status and reason.
Plan Refused(PlanStatus status, std::string reason);

/// Returns a rejected plan if the route of the request is not valid, else a plan without a path. A
/// route is not valid if it has fewer than two waypoints, or a leg without length.
Plan CheckRoute(const PlanRequest& request);

/// Same as CheckRoute, for a planner whose paths have the requested headings at the waypoints. If
/// the request has headings, both ends of a leg may be at the same point, where the car turns from
/// one heading to the other. If the request has headings, a leg is only invalid if its two poses
/// are equal, except for rounding errors.
Plan CheckPoses(const PlanRequest& request);

/// Returns a rejected plan if the requested turning radius is too small for the car.
Plan CheckRadius(const VehicleParams& vehicle, const std::optional<double>& radius);

/// Returns the collision checker for plans that keep `safe_distance` [m] from the obstacles of the
/// request. An obstacle of the request may be nearer than `safe_distance` to the car at the start
/// of the plan. The plan may come closer to an obstacle that is too near at the start, but only to
/// half of the initial distance.
CollisionChecker CheckerFromStart(const PlanRequest& request, double safe_distance);

/// Returns the waypoints after the first one, without those at which an obstacle blocks the car at
/// any heading.
std::vector<Vec2> GoalsOutsideObstacles(const PlanRequest& request, const CollisionChecker& clear);

/// Describes the obstacle nearest to the car's footprint at `pose`, for users: its center, its
/// distance from the footprint or the depth of the overlap, and the required `distance` [m]. The
/// list of obstacles must not be empty.
std::string NearestObstacle(const VehicleParams& vehicle, const Pose2& pose,
                            const std::vector<OrientedBox>& obstacles, double distance);

/// Describes, for users, the first difference between the plan's start and the car's start state:
/// in position, heading or, for a rolling car, steering. Returns an empty text if MakeFeasible
/// accepts the start of the plan.
std::string WrongStart(const Plan& plan, const PlanRequest& request);

/// Returns the rejected plan for the waypoint `index`, at which the car cannot be clear of
/// obstacles at any heading. The reason of the rejected plan names the obstacle and a remedy: a
/// safe distance that fits, or how far to move the waypoint.
Plan GoalBlocked(const PlanRequest& request, std::size_t index, double safe_distance);

/// Returns a rejected plan if an obstacle of the request overlaps the car's footprint at the start.
Plan CheckStart(const PlanRequest& request, double safe_distance);

/// Returns a rejected plan if the car's footprint at one of the stops would be closer to an
/// obstacle of the request than CheckerFromStart allows. The reason of the rejected plan names the
/// obstacle.
Plan CheckStops(const std::vector<Pose2>& stops, const PlanRequest& request, double safe_distance);

/// Returns the turning radius for planning [m]: the requested radius if given, else 1.1 times the
/// car's smallest turning radius.
double RadiusFor(const VehicleParams& vehicle, const std::optional<double>& radius);

/// Returns whether the car is clear of obstacles along path segments that begin at `pose`.
bool IsFree(const CollisionChecker& clear, const Pose2& pose, const std::vector<Segment>& segments);

/// Computes the first meters of a plan for a rolling car (lead_in.h), which end when the car has
/// slowed down for the first step of curvature.
LeadIn LeadInForCurves(const PlanRequest& request, double radius, double min_speed);

/// Sets the members of a plan that depend only on the path, the speed caps and the request.
void Complete(Plan& plan, const PlanRequest& request);

/// Completes a plan whose path consists of the given arcs and straights.
Plan AlongSegments(Plan plan, const PlanRequest& request, std::vector<Segment> segments,
                   double min_speed);

/// Completes a plan whose path follows a polyline. The argument `corners` states how to treat the
/// corners of the polyline. The argument `plan` already contains the diagnostics of the search.
Plan AlongPolyline(Plan plan, const PlanRequest& request, const std::vector<Vec2>& points,
                   Corners corners, double safe_distance, double min_speed);

// Scenario keys shared by several planners that plan from stop to stop.

inline constexpr Key kFootprintDistance{"safe_distance", "m",
                                        "minimum distance of the car's footprint from obstacles"};
inline constexpr Key kGridCell{"cell", "m", "grid cell size"};
inline constexpr Key kGridMargin{"margin", "m",
                                 "margin of the search area around waypoints and obstacles"};
inline constexpr Range kCellSize{.min = 0.05, .max = 10.0};
inline constexpr Key kCornerSpeed{"min_speed", "m/s", "minimum speed in corners"};

/// Visits the scenario keys of planners whose paths consist of arcs and straights.
void VisitCurves(KeyVisitor& keys, std::optional<double>& radius, double& safe_distance,
                 double& min_speed);

/// Visits the scenario keys of planners that round the corners of a polyline.
void VisitCorners(KeyVisitor& keys, Corners& corners, double& safe_distance, double& corner_room);

}  // namespace route
}  // namespace trackbed
