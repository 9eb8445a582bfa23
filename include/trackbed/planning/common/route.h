#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/lead_in.h"
#include "trackbed/planning/common/plan.h"

/// Functions shared by the planners that plan from stop to stop and avoid obstacles.
namespace trackbed {

/// The stops of a route with their headings: the car's start, then every waypoint except the first.
/// Without given headings, the goal's is that of the last leg, and that of a waypoint in between
/// points from the stop before to the stop after.
std::vector<Pose2> PlannedStops(const PlanRequest& request);

namespace route {

/// A rejected plan, with its reason.
Plan Refused(PlanStatus status, std::string reason);

/// The problem with the route itself, if any.
Plan CheckRoute(const PlanRequest& request);

/// Whether the car can turn on the requested radius, if one is given.
Plan CheckRadius(const VehicleParams& vehicle, const std::optional<double>& radius);

/// Whether the car can stand at every stop.
Plan CheckStops(const std::vector<Pose2>& stops, const CollisionChecker& clear);

/// The radius to plan with [m]: the requested one, or 1.1 times the car's smallest.
double RadiusFor(const VehicleParams& vehicle, const std::optional<double>& radius);

/// Whether segments that begin at `pose` are clear.
bool IsFree(const CollisionChecker& clear, const Pose2& pose, const std::vector<Segment>& segments);

/// The lead-in of a rolling car: its curves begin after it has slowed down for the first step of
/// curvature.
LeadIn LeadInForCurves(const PlanRequest& request, double radius, double min_speed);

/// Sets the members that follow from the path and the caps.
void Complete(Plan& plan, const PlanRequest& request);

/// Completes a plan along arcs and straights.
Plan AlongSegments(Plan plan, const PlanRequest& request, std::vector<Segment> segments,
                   double min_speed);

/// Completes a plan along a polyline, with corners treated by `corners`. `plan` has the diagnostics
/// of the search.
Plan AlongPolyline(Plan plan, const PlanRequest& request, const std::vector<Vec2>& points,
                   Corners corners, double safe_distance, double min_speed);

// Keys shared by several of these planners.

inline constexpr Key kFootprintDistance{"safe_distance", "m",
                                        "minimum distance of the car's footprint from obstacles"};
inline constexpr Key kGridCell{"cell", "m", "grid cell size"};
inline constexpr Key kGridMargin{"margin", "m",
                                 "margin of the search area around waypoints and obstacles"};
inline constexpr Range kCellSize{.min = 0.05, .max = 10.0};
inline constexpr Key kCornerSpeed{"min_speed", "m/s", "minimum speed in corners"};

/// Of planners whose paths consist of arcs and straights.
void VisitCurves(KeyVisitor& keys, std::optional<double>& radius, double& safe_distance,
                 double& min_speed);

/// Of planners that round the corners of a polyline.
void VisitCorners(KeyVisitor& keys, Corners& corners, double& safe_distance, double& corner_room);

}  // namespace route
}  // namespace trackbed
