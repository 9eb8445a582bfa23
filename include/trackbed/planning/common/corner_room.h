#pragma once

#include <functional>

#include "trackbed/planning/common/planner.h"

/// Reduces the clearance of rounded corners if the full clearance leaves no room for the path.
namespace trackbed {

/// Returns the plan that `plan` makes with the clearance `corner_room` for rounded corners [m],
/// with 0.3 times this clearance, or with no clearance. Less clearance is tried if the full
/// clearance leaves no path, or only a detour (IsDetour), for example around a gate that the car
/// fits through. The plan with less clearance is chosen if the full clearance leaves no path. The
/// plan with less clearance is also chosen if its path is shorter by at least the car's smallest
/// turning radius, and not slower. A note of the plan states a reduced clearance. Calls `plan` once
/// if `corner_room` is 0 or if the request allows fewer samples than by default, otherwise up to
/// four times.
[[nodiscard]] Plan WithLessCornerRoom(
    const PlanRequest& request, double corner_room,
    const std::function<Plan(const PlanRequest&, double corner_room)>& plan);

}  // namespace trackbed
