#pragma once

#include <string>
#include <vector>

#include "trackbed/planning/common/plan.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the changes of a scenario that lead to a plan, for the reason of a refused plan.
/// PlanRemedies tries each change, and returns only changes with which the planner finds a path.
///
/// If a planner that avoids obstacles finds too little space, PlanRemedies tries a start at rest,
/// the planner `hybrid_astar`, and both. PlanRemedies tries `hybrid_astar` only if no layer
/// (plan.avoid or plan.replan) plans during the run, because paths of `hybrid_astar` may reverse.
/// If a layer plans during the run, PlanRemedies tries a plan around only the `walls` of the map,
/// because that layer handles the obstacles.
///
/// If the car cannot drive a path with given headings and no obstacle is known, PlanRemedies tries
/// the same plan without given headings.
///
/// The arguments `status` and `request` are the status and the request of the refused plan.
/// PlanRemedies makes at most two plans without obstacles, one plan with at most 100 000 random
/// samples, and two searches of at most 20 000 poses.
[[nodiscard]] std::vector<std::string> PlanRemedies(PlanStatus status, const PlanRequest& request,
                                                    const PlanSpec& spec,
                                                    const std::vector<OrientedBox>& walls);

}  // namespace trackbed
