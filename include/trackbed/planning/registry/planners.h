#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/planner.h"

/// The registry of all planners, to which programs can add their own planners.
namespace trackbed {

/// Returns all registered planners; the built-in planners come first.
const std::vector<PlannerEntry>& Planners();

/// Adds a planner to the registry, so that the planner is available in scenarios, `trackbed list`,
/// messages and reports. Call RegisterPlanner only at the start of main, because the function
/// invalidates references to registry entries and is not thread-safe. Throws PreconditionError if
/// another planner has the same name or the same options type.
void RegisterPlanner(PlannerEntry entry);

/// Returns the registry entry of the planner to which the options belong. Throws InternalError if
/// the options are empty.
const PlannerEntry& PlannerFor(const PlannerOptions& options);

/// Returns whether a plan made with the given options may contain reverse segments.
bool MayGoBackwards(const PlannerOptions& options);

/// Returns whether a plan made with the given options may end before the goal (Plan::partial).
bool MayBePartial(const PlannerOptions& options);

/// Returns the distance that plans with these options keep between car and obstacles, which is the
/// value of the planner's key `safe_distance` [m]. Returns nullopt if the planner has no key
/// `safe_distance`.
std::optional<double> PlannerSafeDistance(const PlannerOptions& options);

/// Makes a plan by the planner to which the options belong, and makes the plan feasible
/// (feasibility.h). If no plan exists for the mission, MakePlan throws no exception; the status of
/// the returned plan states the failure. Throws InternalError if the mission contains a number that
/// is not finite, which the caller should have rejected. Throws PreconditionError if an option is
/// outside the range of its key.
FeasiblePlan MakePlan(const PlanRequest& request, const PlannerOptions& options);

}  // namespace trackbed
