#pragma once

#include <functional>

#include "trackbed/planning/common/planner.h"

/// Compares plans by length and driving time.
namespace trackbed {

/// Returns the length of the planned path [m]; infinity if there is no path.
[[nodiscard]] double PlanLength(const Plan& plan);

/// Returns the length of the planned path minus the length of straight lines from the start through
/// the waypoints [m]; infinity if there is no path.
[[nodiscard]] double ExtraLength(const Plan& plan, const PlanRequest& request);

/// Returns whether the planned path is longer than the straight lines through the waypoints by the
/// car's smallest turning radius or more. IsDetour also returns true for a refused plan, which has
/// no path.
[[nodiscard]] bool IsDetour(const Plan& plan, const PlanRequest& request);

/// Returns whether `plan` is shorter than `best` by the car's smallest turning radius or more, and
/// takes no longer to drive. Also returns true if `plan` has a path and `best` is a refused plan.
[[nodiscard]] bool IsShorterAndNotSlower(const Plan& plan, const Plan& best,
                                         const VehicleParams& car);

/// Adds a note to `detour`, the plan of a rolling car, if a car at rest could take a path that is
/// shorter and not slower. The note states the lengths of the rolling car's path and of the path
/// from rest. The function `plan` plans the path of a request. A long route is planned from rest
/// only if its legs up to the second waypoint behind the stopping distance have a shorter path from
/// rest.
void NoteDetourOfRollingStart(const PlanRequest& request, Plan& detour,
                              const std::function<Plan(const PlanRequest&)>& plan);

}  // namespace trackbed
