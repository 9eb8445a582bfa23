#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/planner.h"

/// The registry of planners.
namespace trackbed {

/// Returns all planners; the built-in planners come first.
const std::vector<PlannerEntry>& Planners();

/// Adds a planner to the registry, for scenarios, `trackbed list`, messages and reports. Call
/// RegisterPlanner at the start of main: it invalidates references to entries and is not
/// thread-safe. Throws PreconditionError if the name or the type of the options is taken.
void RegisterPlanner(PlannerEntry entry);

/// Returns the entry of the planner to which the options belong. Throws InternalError for empty
/// options.
const PlannerEntry& PlannerFor(const PlannerOptions& options);

/// Returns whether a plan with these options may contain reverse segments.
bool MayGoBackwards(const PlannerOptions& options);

/// Returns whether a plan with these options may be partial (Plan::partial).
bool MayBePartial(const PlannerOptions& options);

/// Returns the distance [m] that plans with these options keep between car and obstacles: the value
/// of the planner's key `safe_distance`. Returns nullopt for planners without that key.
std::optional<double> PlannerSafeDistance(const PlannerOptions& options);

/// Plans with the planner to which the options belong, and makes the plan feasible (feasibility.h).
/// Never throws for a mission that cannot be planned. Throws InternalError for a mission that the
/// caller should have rejected (a non-finite number). Throws PreconditionError if an option is
/// outside the range of its key.
FeasiblePlan MakePlan(const PlanRequest& request, const PlannerOptions& options);

}  // namespace trackbed
