#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/planning/planner.h"

/// The planners that lead from stop to stop and keep clear of obstacles; see planner.h.
namespace trackbed {

Plan PlanWith(const DubinsOptions& options, const PlanRequest& request);
Plan PlanWith(const ReedsSheppOptions& options, const PlanRequest& request);
Plan PlanWith(const AStarOptions& options, const PlanRequest& request);
Plan PlanWith(const HybridAStarOptions& options, const PlanRequest& request);
Plan PlanWith(const RrtPlannerOptions& options, const PlanRequest& request);

/// What they share.
namespace route {

Plan Refused(PlanStatus status, std::string reason);

/// What is wrong with the route itself, if anything.
Plan CheckRoute(const PlanRequest& request);

/// Fills in what follows from the path and the caps.
void Complete(Plan& plan, const PlanRequest& request);

/// Completes a plan along a polyline whose corners are to be rounded, or that is to have none.
/// `plan` has the diagnostics of how it was found.
Plan AlongPolyline(Plan plan, const PlanRequest& request, const std::vector<Vec2>& points,
                   Corners corners, double safe_distance, double min_speed);

/// Points as they stand in plan.json.
nlohmann::json ToJson(const std::vector<Vec2>& points);

}  // namespace route

}  // namespace trackbed
