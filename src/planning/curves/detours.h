#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/common/waypoint_miss.h"

/// Avoids loops that the planners of curves drive only because of free headings, waypoints that are
/// almost equal, or a rolling start.
namespace trackbed {

/// Returns the length of the shortest curve between two poses for a turning radius [m].
using CurveLength = std::function<double(const Pose2&, const Pose2&, double)>;

/// The functions that make the plans of a planner of curves.
struct CurvePlanning {
  std::function<Plan(const PlanRequest&)> plan;
  /// Returns a faster plan for a request, or the given plan; empty: no plan becomes faster.
  std::function<Plan(const PlanRequest&, Plan)> faster{};
};

/// Returns the plan that `planning` makes for the request, or another plan without
/// detours. A detour is a path that exceeds the straight lines between the waypoints by the car's
/// smallest turning radius or more. A path that stops between start and goal, or that the car
/// cannot drive from its start speed, is a detour, too. If the request has no headings, the
/// function tries two remedies against a detour or a refusal. The first remedy is other headings at
/// the waypoints between start and goal. At each of these waypoints, the
/// function tries sixteen directions. It uses the headings that give the shortest curves, for up to
/// three turning radii. The second remedy leaves out
/// waypoints within a quarter of the car's width from the lines between the other waypoints, if the
/// path passes them within this distance. A note names the waypoints left out.
///
/// A remedy is taken only if the path takes no longer to drive. A remedied path must also be
/// shorter by the smallest turning radius or more, or have fewer stops because waypoints are left
/// out. If the plan still has a detour, a note gives the length of the shorter path that a car at
/// rest could drive. Without obstacles, a note also gives the length of the shorter path without
/// the given headings. The returned plan and the plans that its notes compare are made faster, and
/// the notes state their lengths. Calls `planning.plan` once if there is no detour, otherwise up to
/// 21 times.
Plan WithoutDetours(const PlanRequest& request, const CurveLength& length,
                    const CurvePlanning& planning);

/// Returns the note of a plan that leaves out `count` waypoints for the reason `why`. `miss` is the
/// largest distance of the path from a waypoint.
std::string DescribeLeftOut(std::size_t count, const std::string& why, const WaypointMiss& miss);

}  // namespace trackbed
