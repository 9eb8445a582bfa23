#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/planner.h"

/// The registry of planners.
namespace trackbed {

/// All planners, the built-in ones first.
const std::vector<PlannerEntry>& Planners();

/// Adds a planner to the registry, for scenarios, `trackbed list`, messages and reports. Call
/// RegisterPlanner at the start of main: it invalidates references to entries and is not
/// thread-safe. PreconditionError if the name or the type of the options is taken.
void RegisterPlanner(PlannerEntry entry);

/// The entry of the planner that has these options. InternalError for empty options.
const PlannerEntry& PlannerFor(const PlannerOptions& options);

/// Whether a plan with these options may contain reverse segments.
bool MayGoBackwards(const PlannerOptions& options);

/// Whether a plan with these options may be partial (Plan::partial).
bool MayBePartial(const PlannerOptions& options);

/// The distance [m] that plans with these options keep between car and obstacles: the planner's key
/// `safe_distance`. Nullopt for planners without that key.
std::optional<double> PlannerSafeDistance(const PlannerOptions& options);

/// Plans with the planner that has these options, and makes the plan feasible (feasibility.h).
/// Never throws for a mission that cannot be planned. InternalError for a mission that the caller
/// should have rejected (a non-finite number). PreconditionError for options out of their keys'
/// ranges.
FeasiblePlan MakePlan(const PlanRequest& request, const PlannerOptions& options);

}  // namespace trackbed
