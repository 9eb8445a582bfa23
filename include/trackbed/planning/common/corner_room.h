#pragma once

#include <functional>

#include "trackbed/planning/common/planner.h"

/// Reduces the clearance of rounded corners where it leaves no room for the path.
namespace trackbed {

/// Returns the plan that `plan` makes with the clearance `corner_room` for rounded corners [m],
/// with 0.3 times this clearance, or without it. Less clearance is tried if there is no path, or if
/// the path is longer than the straight lines between the waypoints by the car's smallest turning
/// radius or more, as around a gate that the car fits through. Less clearance is chosen only if it
/// makes a path possible, or the path shorter by this radius or more and not slower. A note then
/// says so. Calls `plan` once if `corner_room` is 0 or the request allows fewer samples than by
/// default, otherwise up to four times.
[[nodiscard]] Plan WithLessCornerRoom(
    const PlanRequest& request, double corner_room,
    const std::function<Plan(const PlanRequest&, double corner_room)>& plan);

}  // namespace trackbed
