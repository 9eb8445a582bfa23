#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/planner.h"

/// The registry of planners.
namespace trackbed {

/// All planners, those of Trackbed first.
const std::vector<PlannerEntry>& Planners();

/// Adds a planner to the registry, for scenarios, `trackbed list`, messages and reports. Call it at
/// the start of main: it invalidates references to entries and is not thread-safe.
/// PreconditionError when the name or the type of the options is taken.
void RegisterPlanner(PlannerEntry entry);

/// The entry of the planner that `options` belong to. InternalError for options of none.
const PlannerEntry& PlannerFor(const PlannerOptions& options);

/// Whether a plan with these options may contain reverse segments.
bool MayGoBackwards(const PlannerOptions& options);

/// Whether a plan with these options may be partial (Plan::partial).
bool MayBePartial(const PlannerOptions& options);

/// The distance [m] that plans with these options keep between car and obstacles: their key
/// `safe_distance`. None for planners without it.
std::optional<double> PlannerSafeDistance(const PlannerOptions& options);

/// Plans with the planner that `options` belong to, and makes the plan feasible (feasibility.h).
/// Never throws for a mission that cannot be planned; InternalError for one that the caller should
/// have refused (a non-finite number), PreconditionError for options out of their keys' ranges.
FeasiblePlan MakePlan(const PlanRequest& request, const PlannerOptions& options);

}  // namespace trackbed
