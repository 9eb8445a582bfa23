#pragma once

namespace trackbed {

/// How planning ended.
enum class PlanStatus {
  kOk,
  kTooFewWaypoints,     ///< The route has fewer waypoints than the planner needs.
  kDuplicateWaypoints,  ///< A leg of the route has zero length.
  kUTurn,  ///< Two successive legs point in opposite directions, so that no fillet can join them.
  /// A turn is tighter than the car can steer, or no radius of a turn fits on its two legs.
  kTurnTooTight,
  /// No radius of a turn leaves enough distance on its two legs for turning the wheels (eq. (C.40)
  /// of Skackauskas, fillet.h).
  kNoRoomForSteering,
  kTurnsOverlap,  ///< The arcs of the given radii are too long for a leg of the route.
  kSearchFailed,  ///< The numerical search found no solution that meets the constraints.
  /// The wheels would have to start turning before the route begins (at the driven distance D_1 <
  /// 0).
  kSteersBeforeStart,
  /// The car starts in or too near to an obstacle, or at a place where the Frenet frame is
  /// undefined.
  kStartBlocked,
  kGoalBlocked,   ///< An obstacle is too near to the goal or a waypoint.
  kNoPath,        ///< No path exists, or no path that meets the requirements of the planner.
  kBudgetUsedUp,  ///< The search for a path ended before the goal was reached.
  kCollides,      ///< The path that the car can drive comes too near to an obstacle.
  kInfeasible,    ///< The plan exceeds the car's limits (feasibility.h).
  /// The path would pass a waypoint farther away than PlanRequest::max_waypoint_miss.
  kWaypointMissed,
};

/// Returns the name of a status as written in plan.json: "ok", "too_few_waypoints", ….
const char* ToString(PlanStatus status);

}  // namespace trackbed
