#pragma once

#include "trackbed/planning/planner.h"

/// The planners that lead from stop to stop and keep clear of obstacles; see planner.h.
namespace trackbed {

Plan PlanWith(const DubinsOptions& options, const PlanRequest& request);
Plan PlanWith(const ReedsSheppOptions& options, const PlanRequest& request);
Plan PlanWith(const AStarOptions& options, const PlanRequest& request);
Plan PlanWith(const HybridAStarOptions& options, const PlanRequest& request);

}  // namespace trackbed
